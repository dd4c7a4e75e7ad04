-- A drop test: an armour unit falls flat, on an edge or on a corner, from heights that close in on the one from which it
-- breaks. Each time it is whole again and starts just above the floor with the velocity of its fall so far.
--
--   ./cdem run examples/drop_test/case.lua --set shape=cubipod --set attitude=corner
--   ./cdem run examples/drop_test/case.lua --set floor=rigid --set fracture_energy=0
local cdem = require "cdem"

local shape = cdem.parameter{ name = "shape", default = "cube", choices = {"cube", "cubipod", "dolos", "tetrapod", "accropode"} }
local attitude = cdem.parameter{ name = "attitude", default = "flat", choices = {"flat", "edge", "corner"} }
local mass = cdem.parameter{ name = "mass", default = 16000.0, range = {1, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 5.0, range = {2, 30}, doc = "Dn over edge of the tets" }
local tension = cdem.parameter{ name = "tensile_strength", default = 3e6, range = {1e4, 1e9}, unit = "Pa" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 100.0, range = {0, 1e6}, unit = "J/m2",
                                  doc = "G_I; 0: springs, brittle" }
local rate = cdem.parameter{ name = "rate_effect", default = false,
                             doc = "strength grows with the rate of strain, fib Model Code 2010; wants G_I above 0" }
local floor = cdem.parameter{ name = "floor", default = "concrete", choices = {"concrete", "rigid"} }
local low = cdem.parameter{ name = "low", default = 0.05, range = {1e-3, 100}, unit = "m", doc = "first height" }
local turns = cdem.parameter{ name = "bisections", default = 4, range = {0, 20}, doc = "after the height is between two" }
local most = cdem.parameter{ name = "most", default = 60.0, range = {0.1, 1e4}, unit = "m", doc = "gives up there" }
local draw = cdem.parameter{ name = "pictures", default = true, doc = "draw the unit that breaks" }
local after = cdem.parameter{ name = "after", default = 0.1, range = {0.01, 10}, unit = "s", doc = "how long the pieces fly on" }

local g, density = 9.81, 2400
local size = (mass / density) ^ (1 / 3) -- nominal diameter
-- Damping grows with the size, as times do: a brittle unit then breaks from the same height at any size.
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = density, stiffness_damping = 5e-7 * size }
local wave_speed = math.sqrt(concrete.youngs_modulus / concrete.density)
local make = { cube = cdem.cube, cubipod = cdem.cubipod, dolos = cdem.dolos, tetrapod = cdem.tetrapod,
               accropode = cdem.accropode }
local unit = make[shape]{ mass = mass, density = concrete.density }
if attitude == "edge" then unit = unit:rotate{ axis = {1, 0, 0}, angle = 45 } end
if attitude == "corner" then unit = unit:rotate{ axis = {1, -1, 0}, angle = math.deg(math.atan(math.sqrt(2))) } end
local gap = 1e-3 * size
unit = unit:translate{ shift = {0, 0, gap - unit:box().min[3]} }
local box, mesh = unit:box(), unit:mesh{ size = size / fineness }
local reach = 1.5 * math.max(box.max[1] - box.min[1], box.max[2] - box.min[2])
local thick = floor == "rigid" and 0.2 * size or 0.5 * size
local slab = cdem.solid.box{ size = {reach, reach, thick}, origin = {(box.min[1] + box.max[1] - reach) / 2,
                                                                     (box.min[2] + box.max[2] - reach) / 2, -thick} }
local slab_mesh = slab:mesh{ size = size / fineness * 1.5 }
local tough = toughness > 0
local joint = cdem.mohr_coulomb{ cohesion = 2 * tension, friction_angle = 35, tensile_strength = tension,
                                 softening = tough and "linear" or "none", fracture_energy_1 = tough and toughness or nil,
                                 fracture_energy_2 = tough and 10 * toughness or nil,
                                 rate_effect = rate and { reference_rate = 1e-6, exponent = 0.018, change_rate = 10,
                                                          exponent_above = 1 / 3 } or nil }
local rough = cdem.coulomb{ friction_angle = 35 }

-- Lets it fall; returns whether a tenth of it has come off, and the model.
local worst_energy, falls = 0, {}
local function fall(height)
  local model = cdem.model{
    bodies = { { shape = slab_mesh, material = concrete, element = floor == "rigid" and "rigid" or nil, name = "floor" },
               { shape = mesh, material = concrete, joint = joint, name = "unit", bonds = tough and "cohesive" or "springs" } },
    contacts = { { "floor", "unit", rough }, { "unit", "unit", rough } } }
  if floor == "rigid" then
    model:fix{ on = "floor" }
  else -- a wide slab on the ground: waves leave it downwards
    model:quiet{ on = cdem.select.plane{ point = {0, 0, -thick}, normal = {0, 0, 1} } }
  end
  model:gravity{ vector = {0, 0, -g} }
  local start = math.sqrt(2 * g * math.max(0, height - gap))
  model:initial_velocity{ on = "unit", velocity = {0, 0, -start} }
  model:run{ duration = 2 * gap / (start + math.sqrt(2 * g * height)) + 30 * size / wave_speed }
  local volumes = {}
  for _, piece in ipairs(model:fragments()) do
    if piece.volume < 1.01 * mesh:volume() and piece.centroid[3] > -gap then
      volumes[#volumes + 1] = piece.volume / mesh:volume()
    end
  end
  table.sort(volumes, function(p, q) return p > q end)
  local largest, counts = volumes[1] or 1, model:counts()
  worst_energy = math.max(worst_energy, model:energy().balance_error)
  falls[#falls + 1] = { height = height, largest = largest }
  cdem.log(string.format("%s on its %s, fall of %.3g m, %.3g m/s: %d springs broken, pieces %.3g and %.3g of the unit", shape,
                         attitude, height, math.sqrt(2 * g * height), counts.broken_tension + counts.broken_shear,
                         largest, volumes[2] or 0))
  return largest <= 0.9, model
end

-- It doubles the height until the unit breaks, or halves it until it stays whole, then halves the ratio of the two heights.
local whole, broken, last = nil, nil, nil
local height = math.max(low, 2 * gap)
while not broken and height <= most do
  local breaks, model = fall(height)
  if breaks then broken, last = height, model else whole = height end
  height = 2 * height
end
height = broken and broken / 2 or 0
while broken and not whole and height > 2 * gap do
  local breaks, model = fall(height)
  if breaks then broken, last = height, model else whole = height end
  height = height / 2
end
for _ = 1, broken and whole and turns or 0 do
  local middle = math.sqrt(whole * broken)
  local breaks, model = fall(middle)
  if breaks then broken, last = middle, model else whole = middle end
end
local critical = broken and whole and math.sqrt(whole * broken)

if broken and draw then
  for frame = 1, 3 do
    last:run{ duration = after / 3 }
    last:picture{ file = string.format("breaks_%d.png", frame), view = "iso", up = "z", colour = "velocity.magnitude",
                  deformation = 1, plain = {"floor"},
                  title = string.format("%s, %s, a fall of %.2g m: %.2g s after the touch", shape, attitude, broken, last.time) }
  end
end
table.sort(falls, function(p, q) return p.height < q.height end)
local heights, largest = {}, {}
for i, one in ipairs(falls) do heights[i], largest[i] = one.height, one.largest end
cdem.write_csv{ file = "falls.csv", columns = { { name = "height_m", values = heights },
                                                { name = "largest_piece", values = largest } } }
cdem.report{
  { name = "critical_height_m", value = critical, unit = "m" },
  { name = "whole_at_m", value = whole, unit = "m" },
  { name = "broken_at_m", value = broken, unit = "m" },
  { name = "critical_velocity_over_t_by_rho_c", value = critical and math.sqrt(2 * g * critical) * concrete.density * wave_speed
                                                        / tension },
  { name = "energy_balance_error", value = worst_energy, reference = 0, kind = "formula", source = "energy is conserved",
    tolerance_absolute = 0.02 },
  { name = "tets", value = mesh.tets },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
