#include "libcdem/vtk/colour_map.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

using Bytes = std::array<int, 3>;

// viridis (van der Walt and Smith 2015) without its darkest fifth, on which outlines would not show
const std::vector<Bytes> viridis = {{65, 68, 135},  {53, 96, 141},  {42, 120, 142},
                                    {33, 144, 140}, {34, 168, 132}, {67, 191, 113},
                                    {122, 209, 81}, {187, 223, 39}, {253, 231, 37}};
// ColorBrewer RdBu without the two darkest ends, on which outlines would not show; blue first
const std::vector<Bytes> blue_white_red = {{33, 102, 172},  {67, 147, 195},  {146, 197, 222},
                                           {209, 229, 240}, {247, 247, 247}, {253, 219, 199},
                                           {244, 165, 130}, {214, 96, 77},   {178, 24, 43}};
// Moreland 2009, nine samples
const std::vector<Bytes> cool_warm = {{59, 76, 192},   {98, 130, 234},  {141, 176, 254},
                                      {184, 208, 249}, {221, 221, 221}, {245, 196, 173},
                                      {244, 154, 123}, {222, 96, 77},   {180, 4, 38}};
const std::vector<Bytes> grey = {{40, 40, 40}, {245, 245, 245}};

// Okabe and Ito 2008, told apart by colour-blind readers
const std::array<Bytes, 8> palette = {{{0, 114, 178},
                                       {213, 94, 0},
                                       {0, 158, 115},
                                       {204, 121, 167},
                                       {86, 180, 233},
                                       {230, 159, 0},
                                       {90, 90, 90},
                                       {150, 110, 60}}};

Colour from_bytes(const Bytes& b) {
  return {b[0] / 255., b[1] / 255., b[2] / 255.};
}

const std::vector<Bytes>& samples(const std::string& name) {
  return name == "blue_white_red" ? blue_white_red
         : name == "cool_warm"    ? cool_warm
         : name == "grey"         ? grey
                                  : viridis;
}

} // namespace

const std::vector<std::string>& colour_map_names() {
  static const std::vector<std::string> names = {"blue_white_red", "cool_warm", "viridis", "grey",
                                                 "categorical"};
  return names;
}

bool diverging(const std::string& colour_map) {
  return colour_map == "blue_white_red" || colour_map == "cool_warm";
}

Colour map_colour(const std::string& colour_map, double place) {
  const std::vector<Bytes>& table = samples(colour_map);
  const double at = std::clamp(place, 0., 1.) * static_cast<double>(table.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), table.size() - 2);
  const double w = at - static_cast<double>(i);
  const Colour a = from_bytes(table[i]), b = from_bytes(table[i + 1]);
  return {a[0] + w * (b[0] - a[0]), a[1] + w * (b[1] - a[1]), a[2] + w * (b[2] - a[2])};
}

Colour ColourScale::operator()(double value) const {
  if (std::isnan(value))
    return {0.8, 0.8, 0.8};
  if (map == "categorical")
    return id_colour(std::llround(value));
  if (diverging(map) && low < 0 && high > 0) // zero takes the middle colour, whatever the range
    return map_colour(map, 0.5 + 0.5 * value / std::max(-low, high));
  return map_colour(map, (value - low) / (high - low));
}

namespace {

constexpr std::size_t enough_values = 200;
constexpr double tail = 0.005; // of the values, at each end
constexpr double taken = 4;    // times the range of the others: what the outliers would make of it

// The range of all values but the tails, where these would take most of the colours; the values lose their order.
std::optional<std::array<double, 2>> without_outliers(std::vector<double>& values) {
  if (values.size() < enough_values)
    return std::nullopt;
  const auto at = [&](double part) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const double low = at(tail), high = at(1 - tail);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (!(high > low) || *most - *least < taken * (high - low))
    return std::nullopt;
  return std::array<double, 2>{low, high};
}

} // namespace

ColourScale colour_scale(const std::vector<double>& values, bool id, const std::string& colour_map,
                         const std::optional<std::array<double, 2>>& range) {
  const std::vector<std::string>& names = colour_map_names();
  if (colour_map != "auto" && std::find(names.begin(), names.end(), colour_map) == names.end()) {
    std::string list = "auto";
    for (const std::string& name : names)
      list += ", " + name;
    throw geom::InputError("colour_map", '"' + colour_map + '"', "one of " + list);
  }
  if (range && !(std::isfinite((*range)[0]) && std::isfinite((*range)[1]) && (*range)[0] < (*range)[1]))
    throw geom::InputError("range", "{" + geom::text((*range)[0]) + ", " + geom::text((*range)[1]) + "}",
                           "two numbers, the lower one first");
  std::vector<double> known;
  for (const double value : values)
    if (std::isfinite(value))
      known.push_back(value);
  double low = 0, high = 0;
  std::optional<std::array<double, 2>> all;
  if (range) {
    low = (*range)[0];
    high = (*range)[1];
  } else if (!known.empty()) {
    const auto [least, most] = std::minmax_element(known.begin(), known.end());
    low = *least;
    high = *most;
    if (const auto most_of_them = without_outliers(known); most_of_them && !id) {
      all = {low, high};
      low = (*most_of_them)[0];
      high = (*most_of_them)[1];
    }
  }
  ColourScale scale{colour_map, low, high, all};
  // A sliver of the other sign (2 %) is noise on a field of one sign, not a change of sign.
  const bool both_signs = low < 0 && high > 0 && std::min(-low, high) > 0.02 * std::max(-low, high);
  if (colour_map == "auto")
    scale.map = id ? "categorical" : both_signs ? "blue_white_red" : "viridis";
  if (!(scale.low < scale.high)) { // one value everywhere: give it the middle of a range
    const double half = scale.low != 0 ? 0.5 * std::abs(scale.low) : 1;
    scale.low -= half;
    scale.high += half;
  }
  return scale;
}

Colour palette_colour(std::size_t index) {
  Colour colour = from_bytes(palette[index % palette.size()]);
  const std::size_t round = index / palette.size() % 3; // as they are, darker, lighter
  for (double& part : colour)
    part = round == 1 ? 0.55 * part : round == 2 ? 0.55 * part + 0.45 : part;
  return colour;
}

Colour id_colour(std::int64_t id) {
  // Hue by the golden ratio, so that consecutive ids lie far apart; lightness in three steps.
  const double turn = static_cast<double>(id) * 0.6180339887498949;
  const double hue = 2 * M_PI * (turn - std::floor(turn));
  const double light = 0.74 + 0.06 * static_cast<double>(((id % 3) + 3) % 3);
  const double spread = 0.14;
  // Three cosines a third of a turn apart: even steps of hue without the glare of pure colours.
  const auto channel = [&](double shift) {
    return std::clamp(light + spread * std::cos(hue - shift), 0., 1.);
  };
  return {channel(0), channel(2 * M_PI / 3), channel(4 * M_PI / 3)};
}

} // namespace cdem
