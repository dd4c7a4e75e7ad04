#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/command_line/option_values.hpp"
#include "apps/cdem/commands/commands.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedRender {
  std::string file, output, colour, deformation = "0", view = "front", up = "y", size = "1600x1200", range,
                                    hidden, colour_map = "auto", title, dpi = "300";
  bool colour_given = false, no_edges = false, no_broken_bonds = false, no_colour_bar = false,
       no_legend = false, no_axes = false;
};

} // namespace

Command render_command() {
  const auto typed = std::make_shared<TypedRender>();
  Command command("render", "draw a picture of a saved file");
  command.argument("FILE", typed->file, "the .vtu, .pvtu or .vtkhdf file");
  command.value("--colour,--color,-c", typed->colour, "FIELD",
                "field to colour by (displacement.magnitude); \"\": plain blocks", &typed->colour_given);
  command.value("--deformation,-d", typed->deformation, "S", "scale of the displacement (0: undeformed)");
  command.value("--view,-v", typed->view, "VIEW", "front, back, left, right, top, bottom or iso (front)");
  command.value("--up", typed->up, "AXIS", "the axis that points up: y or z (y)");
  command.value("--size,-s", typed->size, "WxH", "pixels (1600x1200); WIDTH alone: as high as needed");
  command.value("--range,-r", typed->range, "LOW,HIGH", "values at the ends of the colours");
  command.value("--colour-map,--color-map", typed->colour_map, "NAME",
                "auto, blue_white_red, cool_warm, viridis, grey or categorical (auto)");
  command.value("--title,-t", typed->title, "TEXT", "title of the picture");
  command.value("--hidden", typed->hidden, "BODY,...",
                "bodies to leave out, by name or by number (0 is the first); cdem info FILE.vtu lists them");
  command.flag("--no-edges", typed->no_edges, "without the outlines of the blocks");
  command.flag("--no-broken-bonds", typed->no_broken_bonds, "without broken bonds");
  command.flag("--no-colour-bar,--no-color-bar", typed->no_colour_bar, "without the colour bar");
  command.flag("--no-legend", typed->no_legend, "without the legend");
  command.flag("--no-axes", typed->no_axes, "without the axes");
  add_output(command, typed->output, "FILE",
             "the picture, .png, .svg or .pdf (a .png beside the .vtu, named after it and the field)");
  command.value("--dpi", typed->dpi, "N", "pixels in an inch where the picture is printed (300)");
  command.examples = "  cdem render results/plate/result.vtu --colour stress.yy --range -40e6,0\n"
                     "  cdem render result.vtu -c displacement.x -d 20 -s 2400x1800 -o ux.png\n";
  command.action = [typed, name = command.name](const TypedLine&) -> Action {
    refuse_ranks(name);
    require_file(typed->file, name, "FILE.vtu");
    RenderCommand c;
    c.file = typed->file;
    c.output = typed->output;
    if (typed->colour_given)
      c.colour = typed->colour;
    c.deformation = real_number("--deformation", typed->deformation);
    c.view = typed->view;
    c.up = typed->up;
    c.size = size_value("--size", typed->size);
    c.dpi = real_number("--dpi", typed->dpi);
    if (!typed->range.empty())
      c.range = range_value("--range", typed->range);
    if (!typed->hidden.empty())
      c.hidden = names_value("--hidden", typed->hidden);
    c.colour_map = typed->colour_map;
    c.title = typed->title;
    c.edges = !typed->no_edges;
    c.broken_bonds = !typed->no_broken_bonds;
    c.colour_bar = !typed->no_colour_bar;
    c.legend = !typed->no_legend;
    c.axes = !typed->no_axes;
    return [c] { return render_picture(c); };
  };
  return command;
}

} // namespace cdem::app
