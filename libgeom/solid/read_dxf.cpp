// Triangles of an ASCII DXF file (Autodesk's DXF reference): pairs of lines, a group code and its value. Read are the
// entities that are faces:
//
//   3DFACE                        corners 10/20/30 to 13/23/33, the last two equal in a triangle
//   POLYLINE with 64 in code 70   a polyface mesh: VERTEX 128 + 64 is a point, VERTEX 128 a face over points 71 to 74
//   POLYLINE with 16 in code 70   a mesh of 71 x 72 points; 1 and 32 close it along its first and second direction
//
// A face of four corners is cut along its shorter diagonal. Debian's dxflib drops the corners of polyface meshes, and libdime
// is no longer kept; gmsh and OpenCASCADE do not read DXF.
#include "libgeom/solid/read_surface.hpp"

#include "libgeom/core/error.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

namespace geom {
namespace {

constexpr int point_of_polyface = 192, face_of_polyface = 128, frame_of_spline = 16; // flags of a VERTEX
constexpr int is_polyface = 64, is_mesh = 16, closed_first = 1, closed_second = 32;  // of a POLYLINE

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

struct Pair {
  int code = 0;
  std::string_view value;
};

class Pairs {
public:
  Pairs(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  std::optional<Pair> next() {
    const auto code = line();
    if (!code || (code->empty() && at_ >= bytes_.size()))
      return std::nullopt;
    Pair pair;
    const auto [end, error] = std::from_chars(code->data(), code->data() + code->size(), pair.code);
    if (error != std::errc() || end != code->data() + code->size())
      refuse("a group code must stand here, a whole number");
    const auto value = line();
    if (!value)
      refuse("a group code has no value behind it: the file is cut off");
    pair.value = *value;
    return pair;
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError("file", '"' + path_ + '"', "an ASCII DXF file",
                     "line " + std::to_string(line_) + ": " + why);
  }
  double number(const Pair& pair) const {
    double x = 0;
    const auto [end, error] = std::from_chars(pair.value.data(), pair.value.data() + pair.value.size(), x);
    if (pair.value.empty() || error != std::errc() || end != pair.value.data() + pair.value.size() ||
        !std::isfinite(x))
      refuse("group code " + std::to_string(pair.code) + " must have a finite number");
    return x;
  }
  int whole(const Pair& pair) const {
    const double x = number(pair);
    if (!(std::abs(x) <= 1e9) || x != std::floor(x))
      refuse("group code " + std::to_string(pair.code) + " must have a whole number");
    return static_cast<int>(x);
  }

private:
  std::optional<std::string_view> line() {
    if (at_ >= bytes_.size())
      return std::nullopt;
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    const std::string_view text(bytes_.data() + at_, end - at_);
    at_ = end + 1;
    ++line_;
    return trimmed(text);
  }
  const std::string& bytes_;
  const std::string& path_;
  std::size_t at_ = 0, line_ = 0;
};

// One entity with the codes that faces are made of.
struct Entity {
  std::string kind;
  std::array<Vec3, 4> point{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}; // codes 1i, 2i, 3i
  std::array<bool, 4> given{};
  int flags = 0;              // code 70
  std::array<int, 4> index{}; // codes 71 to 74
};

void take(Entity& entity, const Pair& pair, const Pairs& pairs) {
  const int axis = pair.code / 10 - 1, corner = pair.code % 10;
  if (axis >= 0 && axis < 3 && corner < 4) {
    entity.point[corner][axis] = pairs.number(pair);
    entity.given[corner] = true;
  } else if (pair.code == 70) {
    entity.flags = pairs.whole(pair);
  } else if (pair.code >= 71 && pair.code <= 74) {
    entity.index[pair.code - 71] = pairs.whole(pair);
  }
}

class Faces {
public:
  explicit Faces(const Pairs& pairs) : pairs_(pairs) {}

  void add(const Entity& entity) {
    if (entity.kind == "3DFACE") {
      if (!entity.given[0] || !entity.given[1] || !entity.given[2])
        pairs_.refuse("the 3DFACE before this lacks a corner");
      face({entity.point[0], entity.point[1], entity.point[2],
            entity.given[3] ? entity.point[3] : entity.point[2]});
    } else if (entity.kind == "POLYLINE") {
      finish();
      mesh_ = entity;
      if ((entity.flags & (is_polyface | is_mesh)) == 0)
        ++others_["POLYLINE that is no mesh"];
    } else if (entity.kind == "VERTEX" && mesh_) {
      vertex(entity);
    } else if (entity.kind == "SEQEND") {
      finish();
    } else if (!entity.kind.empty() && entity.kind != "VERTEX") {
      ++others_[entity.kind];
    }
  }
  void finish() {
    if (mesh_ && (mesh_->flags & is_mesh) != 0)
      grid();
    mesh_.reset();
    points_.clear();
  }
  std::vector<Vec3> corners;
  const std::map<std::string, int>& others() const { return others_; }

private:
  void face(const std::array<Vec3, 4>& x) {
    const auto triangle = [&](int a, int b, int c) { corners.insert(corners.end(), {x[a], x[b], x[c]}); };
    if (x[2] == x[3]) {
      triangle(0, 1, 2);
    } else if ((x[2] - x[0]).squaredNorm() <= (x[3] - x[1]).squaredNorm()) {
      triangle(0, 1, 2);
      triangle(0, 2, 3);
    } else {
      triangle(0, 1, 3);
      triangle(1, 2, 3);
    }
  }
  void vertex(const Entity& entity) {
    if ((mesh_->flags & is_polyface) == 0 || (entity.flags & point_of_polyface) == point_of_polyface) {
      if ((entity.flags & frame_of_spline) == 0)
        points_.push_back(entity.point[0]);
      return;
    }
    if ((entity.flags & face_of_polyface) == 0)
      pairs_.refuse("a VERTEX of a polyface mesh must have 128 or 192 in code 70");
    std::array<Vec3, 4> x;
    int last = 0;
    for (int i = 0; i < 4; ++i) {
      const int number = std::abs(entity.index[i]); // a negative one has an edge that is not drawn
      if (number == 0 && i == 3) {
        x[3] = x[2];
        break;
      }
      if (number < 1 || number > static_cast<int>(points_.size()))
        pairs_.refuse("a face of a polyface mesh names point " + std::to_string(entity.index[i]) + " of " +
                      std::to_string(points_.size()) + ", or has fewer than three");
      x[i] = points_[number - 1];
      last = number;
    }
    static_cast<void>(last);
    face(x);
  }
  void grid() {
    const auto m = static_cast<std::size_t>(std::max(mesh_->index[0], 0)),
               n = static_cast<std::size_t>(std::max(mesh_->index[1], 0));
    if (m < 2 || n < 2 || m > points_.size() || n > points_.size() || m * n != points_.size())
      pairs_.refuse("the mesh before this has " + std::to_string(points_.size()) +
                    " points: must be those of codes 71 x 72, " + std::to_string(mesh_->index[0]) + " x " +
                    std::to_string(mesh_->index[1]));
    const std::size_t rows = m - ((mesh_->flags & closed_first) == 0 ? 1 : 0),
                      columns = n - ((mesh_->flags & closed_second) == 0 ? 1 : 0);
    const auto at = [&](std::size_t i, std::size_t j) -> const Vec3& { return points_[i % m * n + j % n]; };
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j)
        face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }

  const Pairs& pairs_;
  std::optional<Entity> mesh_; // the POLYLINE whose vertices come now
  std::vector<Vec3> points_;
  std::map<std::string, int> others_;
};

// Note on the unit of $INSUNITS; empty for metres and for unknown units.
std::string unit_note(int unit) {
  static const std::map<int, const char*> units{{1, "inches; scale = 0.0254"},
                                                {2, "feet; scale = 0.3048"},
                                                {4, "millimetres; scale = 0.001"},
                                                {5, "centimetres; scale = 0.01"},
                                                {7, "kilometres; scale = 1000"}};
  const auto found = units.find(unit);
  return found == units.end() ? "" : std::string("its header says ") + found->second + " makes them metres";
}

} // namespace

FileTriangles dxf_triangles(const std::string& bytes, const std::string& path) {
  if (bytes.compare(0, 22, "AutoCAD Binary DXF\r\n\x1a") == 0 ||
      bytes.compare(0, 18, "AutoCAD Binary DXF") == 0)
    throw InputError("file", '"' + path + '"', "an ASCII DXF file", "it is a binary one; save it as ASCII");
  Pairs pairs(bytes, path);
  Faces faces(pairs);
  Entity entity;
  std::string section;
  int unit = 0;
  bool named = true, unit_next = false, ended = false;
  while (const auto pair = pairs.next()) {
    if (pair->code == 0) {
      faces.add(entity);
      entity = {};
      if (pair->value == "EOF") {
        ended = true;
        break;
      }
      named = pair->value != "SECTION";
      if (pair->value == "ENDSEC")
        section.clear();
      else if (section == "ENTITIES")
        entity.kind = std::string(pair->value.substr(0, 32));
    } else if (!named && pair->code == 2) {
      section = std::string(pair->value.substr(0, 32));
      named = true;
    } else if (section == "ENTITIES") {
      take(entity, *pair, pairs);
    } else if (section == "HEADER") {
      if (unit_next && pair->code == 70)
        unit = pairs.whole(*pair);
      unit_next = pair->code == 9 && pair->value == "$INSUNITS";
    }
  }
  if (!ended)
    pairs.refuse("the file ends without EOF: it is cut off");
  faces.finish();
  FileTriangles result;
  result.corners = std::move(faces.corners);
  std::string others;
  for (const auto& [kind, count] : faces.others()) {
    std::string shown;
    for (const char c : kind)
      shown += c >= ' ' && c < 127 ? c : '?';
    others += (others.empty() ? "" : ", ") + std::to_string(count) + " " + shown;
    if (others.size() > 200) {
      others += ", ...";
      break;
    }
  }
  if (!others.empty())
    result.note = "left out, since they are no faces: " + others;
  if (const std::string note = unit_note(unit); !note.empty())
    result.note += (result.note.empty() ? "" : "; ") + note;
  return result;
}

} // namespace geom
