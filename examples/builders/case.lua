-- Every builder of block assemblies, one picture each.
--
--   ./cdem run examples/builders/case.lua
local cdem = require "cdem"

local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }

local figures = {}
local function draw(name, shape, title, volume)
  local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = joint } } }
  model:picture{ file = name .. ".png", title = title, colour = "block_id", colour_map = "categorical", colour_bar = false,
                 view = "iso", up = "z", size = {1600, 0} }
  model:save{ file = name .. ".vtu" }
  local counts = model:counts()
  figures[#figures + 1] = { name = name .. "_blocks", value = counts.blocks }
  figures[#figures + 1] = { name = name .. "_interfaces", value = counts.interfaces }
  figures[#figures + 1] = { name = name .. "_volume_m3", value = shape:volume(), unit = "m3", reference = volume,
                            kind = "formula", source = "of the box", tolerance = 1e-9 }
end

local cube = cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 1} }
draw("grid", cdem.grid{ size = {1, 1, 1}, divisions = {4, 4, 4} }, "grid", 1)
draw("voronoi", cdem.voronoi{ size = {1, 1, 1}, count = 100, seed = 1 }, "voronoi", 1)
draw("voronoi_extruded", cdem.voronoi{ size = {1, 1, 0.1}, count = 60, seed = 1, extruded = true }, "voronoi, extruded", 0.1)
draw("bricks", cdem.bricks{ size = {2, 0.25, 1}, brick = {0.5, 0.25, 0.2} }, "bricks", 0.5)
draw("joint_sets",
     cdem.cut_by_joints{ shape = cube, seed = 1,
                         sets = { { dip = 60, dip_direction = 120, spacing = 0.2, spacing_scatter = 0.2 },
                                  { dip = 80, dip_direction = 210, spacing = 0.3, dip_scatter = 3 },
                                  { dip = 10, dip_direction = 0, spacing = 0.35 } } },
     "cut_by_joints", 1)
draw("convex_hull",
     cdem.convex_hull{ points = { {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.3, 0.9}, {0.7, 0.3, 0.8}, {0.6, 0.7, 1} } },
     "convex_hull")
cdem.report(figures)
