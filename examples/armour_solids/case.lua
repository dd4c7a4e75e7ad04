-- Free-form solids: armour units, boolean operations, meshes with their quality; a picture of each.
--
--   ./cdem run examples/armour_solids/case.lua
local cdem = require "cdem"

local density = cdem.parameter{ name = "density", default = 2500, range = {500, 5000}, unit = "kg/m3" }
local mass = cdem.parameter{ name = "mass", default = 5000, range = {0.01, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 16, range = {3, 60} } -- tetrahedra along the height

-- Volume over height cubed, and where the figure is from.
local units = {
  { name = "accropode_slender", solid = cdem.accropode{ mass = mass, density = density, shape = "slender" }, ratio = 0.34 },
  { name = "accropode_stocky", solid = cdem.accropode{ mass = mass, density = density, shape = "stocky" }, ratio = 0.34 },
  { name = "dolos", solid = cdem.dolos{ mass = mass, density = density }, ratio = 0.16 },
  { name = "tetrapod", solid = cdem.tetrapod{ mass = mass, density = density }, ratio = 0.28 },
  { name = "antifer", solid = cdem.antifer{ mass = mass, density = density }, ratio = 1.0247 },
  { name = "cube", solid = cdem.cube{ mass = mass, density = density }, ratio = 1 },
}

local figures = {}
for _, unit in ipairs(units) do
  local solid = unit.solid
  local mesh = solid:mesh{ size = solid.height / fineness }
  local quality = mesh:quality()
  mesh:save{ file = unit.name .. ".vtu" }
  mesh:picture{ file = unit.name .. ".png", title = (unit.name:gsub("_", " ")), edges = "mesh", view = "iso", up = "z",
                size = {1000, 800} }
  cdem.log(string.format("%-18s height %.3f m, V/H^3 %.4f, %5d tets, radius ratio %.2f (mean %.2f), dihedral %.0f to %.0f deg",
                         unit.name, solid.height, solid:volume() / solid.height ^ 3, quality.tets, quality.min_radius_ratio,
                         quality.mean_radius_ratio, quality.min_dihedral, quality.max_dihedral))
  figures[#figures + 1] = { name = unit.name .. "_volume_ratio", value = solid:volume() / solid.height ^ 3,
                            reference = unit.ratio, kind = "formula" }
  figures[#figures + 1] = { name = unit.name .. "_min_radius_ratio", value = quality.min_radius_ratio }
end

-- A unit held at its feet, finer along the root of a nose: faces picked by side and named.
local H = units[1].solid.height
local root = units[1].solid:mesh{ size = H / 12,
                                  refine = { { line = { {0.21 * H, -0.1 * H, 0.21 * H}, {0.21 * H, 0.1 * H, 0.21 * H} },
                                               size = H / 60, radius = 0.02 * H } } }
local held = root:faces{ side = "z-", name = "held" }
root:save{ file = "refined.vtu" }
root:picture{ file = "refined.png", title = "finer along a nose's root", colour = "min_dihedral", edges = "mesh", view = "iso", up = "z",
              size = {1000, 800} }

-- Boolean operations: a ball cut out of a box, the two shared out into regions that share nodes.
local box = cdem.solid.box{ size = {2, 2, 2}, origin = {-1, -1, -1} }
local ball = cdem.solid.sphere{ radius = 1.2 }
local hollow = cdem.solid.cut{ solid = box, tools = { ball } }
hollow:mesh{ size = 0.1 }:picture{ file = "cut.png", title = "box minus ball", edges = "mesh", view = "iso", up = "z", size = {1000, 800} }
local pieces = cdem.solid.fragments{ solids = { box, cdem.solid.cylinder{ base = {-2, 0, 0}, axis = {4, 0, 0}, radius = 0.6 } } }
pieces:mesh{ size = 0.15 }:picture{ file = "fragments.png", title = "fragments share nodes", colour = "region", edges = "mesh",
                                    view = "iso", up = "z", size = {1000, 800} }

cdem.report(figures)
cdem.log(string.format("held: %d faces, %.4f m2; fragments: %d regions", held.count, held.area, #pieces))
