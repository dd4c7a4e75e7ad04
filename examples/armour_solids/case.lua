-- Free-form solids: armour units, boolean operations, meshes with their quality; a picture of each.
--
--   ./cdem run examples/armour_solids/case.lua
local cdem = require "cdem"

local density = cdem.parameter{ name = "density", default = 2500, range = {500, 5000}, unit = "kg/m3" }
local mass = cdem.parameter{ name = "mass", default = 5000, range = {0.01, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 16, range = {3, 60} } -- tetrahedra along the height

-- Volume over height cubed, and how near the shapes come to it.
local manual = "Shore Protection Manual 1984, chapter 7"
local units = {
  { name = "accropode_slender", solid = cdem.accropode{ mass = mass, density = density, shape = "slender" },
    ratio = 0.34, tolerance = 0.005 },
  { name = "accropode_stocky", solid = cdem.accropode{ mass = mass, density = density, shape = "stocky" },
    ratio = 0.34, tolerance = 0.005 },
  { name = "dolos", solid = cdem.dolos{ mass = mass, density = density }, ratio = 0.16,
    tolerance = 0.03, source = manual },
  { name = "tetrapod", solid = cdem.tetrapod{ mass = mass, density = density }, ratio = 0.28,
    tolerance = 0.005, source = manual },
  { name = "antifer", solid = cdem.antifer{ mass = mass, density = density }, ratio = 1.0247,
    tolerance = 1e-3 },
  { name = "cube", solid = cdem.cube{ mass = mass, density = density }, ratio = 1, tolerance = 1e-9 },
}

local function draw(mesh, name, title, more)
  local options = { file = name .. ".png", title = title, edges = "mesh", view = "iso", up = "z", size = {1600, 0} }
  for key, value in pairs(more or {}) do options[key] = value end
  mesh:picture(options)
end

local figures = {}
for _, unit in ipairs(units) do
  local solid = unit.solid
  local mesh = solid:mesh{ size = solid.height / fineness }
  local quality = mesh:quality()
  mesh:save{ file = unit.name .. ".vtu" }
  draw(mesh, unit.name, (unit.name:gsub("_", " ")))
  local ratio = solid:inertia{}.principal_ratio
  cdem.log(string.format("%-18s height %.3f m, V/H^3 %.4f, inertia ratio %.2f; %5d tets, %4d nodes, radius ratio "
                           .. "%.2f (mean %.2f), dihedral %.0f to %.0f deg",
                         unit.name, solid.height, solid:volume() / solid.height ^ 3, ratio, quality.tets, quality.nodes,
                         quality.min_radius_ratio, quality.mean_radius_ratio, quality.min_dihedral, quality.max_dihedral))
  figures[#figures + 1] = { name = unit.name .. "_volume_ratio", value = solid:volume() / solid.height ^ 3,
                            reference = unit.ratio, kind = "formula", source = unit.source, tolerance = unit.tolerance }
  figures[#figures + 1] = { name = unit.name .. "_tets", value = quality.tets }
  figures[#figures + 1] = { name = unit.name .. "_nodes", value = quality.nodes }
  figures[#figures + 1] = { name = unit.name .. "_min_radius_ratio", value = quality.min_radius_ratio }
  figures[#figures + 1] = { name = unit.name .. "_principal_inertia_ratio", value = ratio }
end

-- A unit finer along the root of a nose, whose end is picked by its side and named.
local unit = units[1].solid
local H = unit.height
local root = { { 0.21 * H, -0.1 * H, 0.21 * H }, { 0.21 * H, 0.1 * H, 0.21 * H } }
local mesh = unit:mesh{ size = H / 12, refine = { { line = root, size = H / 60, radius = 0.02 * H } } }
local pushed = mesh:faces{ side = "x+", name = "pushed" }
mesh:save{ file = "refined.vtu" }
draw(mesh, "refined", "finer along a nose's root", { colour = "radius_ratio" })
draw(mesh, "named", "faces found by their side", { colour = "on_pushed", colour_map = "categorical" })

-- Boolean operations: a ball cut out of a box; a box and a bar with a corner cut away, as regions that share nodes.
local box = cdem.solid.box{ size = {2, 2, 2}, origin = {-1, -1, -1} }
local hollow = cdem.solid.cut{ solid = box, tools = { cdem.solid.sphere{ radius = 1.2 } } }
draw(hollow:mesh{ size = 0.1 }, "cut", "box minus ball")
local bar = cdem.solid.cylinder{ base = {-1.6, 0, 0}, axis = {3.2, 0, 0}, radius = 0.6 }
local corner = cdem.solid.box{ size = {3, 3, 3}, origin = {0, -3, 0} }
local pieces = cdem.solid.fragments{ solids = { cdem.solid.cut{ solid = box, tools = { corner } },
                                                cdem.solid.cut{ solid = bar, tools = { corner } } } }
draw(pieces:mesh{ size = 0.15 }, "fragments", "regions that share nodes", { colour = "region", colour_map = "categorical" })

-- The slope that units lie on, turned to show its face.
local slope = cdem.slope{ gradient = 1 / 1.5, length = 6, width = 4 }
draw(slope:rotate{ axis = {0, 0, 1}, angle = 180 }:mesh{ size = 0.5 }, "slope", "slope of 1:1.5")
figures[#figures + 1] = { name = "slope_volume_m3", value = slope:volume(), reference = 48, kind = "formula",
                          tolerance = 1e-9 }

cdem.report(figures)
cdem.log(string.format("pushed: %d faces, %.4f m2; fragments: %d regions", pushed.count, pushed.area, #pieces))
