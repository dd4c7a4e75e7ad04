-- An armour unit is dropped on a rigid floor from rising heights until it breaks. Each time it is whole again and starts
-- just above the floor with the velocity of its fall so far; the gap left counts as part of the height.
--
--   ./cdem run examples/bouncing_unit/case.lua [--set fineness=8] [--set mass=9000] [--set tensile_strength=1.5e6]
--   ./cdem run examples/bouncing_unit/case.lua --set fracture_energy=100 --set height=2 --set falls=1 --set fineness=5
local cdem = require "cdem"

local mass = cdem.parameter{ name = "mass", default = 5000.0, range = {1, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 6.0, range = {3, 30}, doc = "height over edge of the tets" }
local tension = cdem.parameter{ name = "tensile_strength", default = 3e6, range = {1e4, 1e9}, unit = "Pa" }
local tilt = cdem.parameter{ name = "tilt", default = 30.0, range = {0, 90}, unit = "deg", doc = "about (1, 1, 0)" }
local growth = cdem.parameter{ name = "growth", default = 1.5, range = {1.01, 4}, doc = "of the height, from fall to fall" }
local from = cdem.parameter{ name = "height", default = 0.0, range = {0, 1000}, unit = "m",
                             doc = "of the first fall; 0: one that a flat bar would survive" }
local falls = cdem.parameter{ name = "falls", default = 40, range = {1, 1000}, doc = "at most, if it does not break" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 0.0, range = {0, 1e6}, unit = "J/m2",
                                  doc = "G_I of a unit that is continuous until it cracks; 0: springs, brittle" }
local after = cdem.parameter{ name = "after", default = 0.06, range = {0, 10}, unit = "s", doc = "how long the pieces fly on" }

local g = 9.81
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500, stiffness_damping = 1e-6 }
local wave_speed = math.sqrt(concrete.youngs_modulus / concrete.density)
local solid = cdem.accropode{ mass = mass, density = concrete.density, shape = "stocky" }
local H = solid.height
local unit = solid:rotate{ axis = {1, 1, 0}, angle = tilt }
local gap = 1e-3 * H
unit = unit:translate{ shift = {0, 0, gap - unit:box().min[3]} }
local mesh = unit:mesh{ size = H / fineness }
local floor = cdem.solid.box{ size = {2 * H, 2 * H, 0.2 * H}, origin = {-H, -H, -0.2 * H} }:mesh{ size = 0.2 * H }
local rough = cdem.coulomb{ friction_angle = 35 }
local tough = toughness > 0
local joint = cdem.mohr_coulomb{ cohesion = 2 * tension, friction_angle = 35, tensile_strength = tension,
                                 softening = tough and "linear" or "none", fracture_energy_1 = tough and toughness or nil,
                                 fracture_energy_2 = tough and 10 * toughness or nil }

-- The velocity at a time, from the kinetic energy of a fall that does not turn the unit.
local function velocity_at(model, time)
  local history = model:history()
  local function velocity(row) return math.sqrt(2 * history.kinetic_energy[row] / (concrete.density * mesh:volume())) end
  local row = 2
  if #history.time < row then return 0 end -- a run that is only checked has none
  while history.time[row] < time do row = row + 1 end
  local part = (time - history.time[row - 1]) / (history.time[row] - history.time[row - 1])
  return (1 - part) * velocity(row - 1) + part * velocity(row)
end

-- Lets it fall; returns what came of it and the model.
local function fall(height)
  local model = cdem.model{
    bodies = { { shape = floor, material = concrete, element = "rigid", name = "floor" },
               { shape = mesh, material = concrete, joint = joint, name = "unit",
                 bonds = tough and "cohesive" or "springs" } },
    contacts = { { "floor", "unit", rough }, { "unit", "unit", rough } },
  }
  model:fix{ on = "floor" }
  model:gravity{ vector = {0, 0, -g} }
  local velocity, start = math.sqrt(2 * g * height), math.sqrt(2 * g * (height - gap))
  model:initial_velocity{ on = "unit", velocity = {0, 0, -start} }
  -- Until it has touched and waves have gone up and down it fifteen times.
  local touches = 2 * gap / (start + velocity)
  model:run{ duration = touches + 30 * H / wave_speed }
  local volumes, counts = {}, model:counts()
  for _, piece in ipairs(model:fragments()) do
    if not piece.held then volumes[#volumes + 1] = piece.volume / mesh:volume() end
  end
  table.sort(volumes, function(p, q) return p > q end)
  local drop = { height = height, velocity = velocity, bonds = counts.broken_tension + counts.broken_shear,
                 largest = volumes[1], second = volumes[2] or 0, rebound = model:mean("velocity.z", "unit") / velocity,
                 energy_error = model:energy().balance_error, touch_velocity = velocity_at(model, touches),
                 penetration = model:contacts().deepest / H }
  drop.broken = drop.second >= 0.1
  cdem.log(string.format("fall of %.3g m, %.3g m/s: %d bonds broken, pieces %.3g and %.3g of the unit", height, velocity,
                         drop.bonds, drop.largest, drop.second))
  return drop, model
end

-- The first fall but for the gap: a third of the velocity at which a bar that hits flat is stressed to T, rho c v = T.
local first = from > 0 and from or gap + 0.1 * (tension / (concrete.density * wave_speed)) ^ 2 / (2 * g)
if first < gap then error(string.format("height = %g: must be at least the gap left to fall, %.3g m", from, gap)) end
local drops, last = {}
repeat
  local drop, model = fall(gap + (first - gap) * growth ^ #drops)
  drops[#drops + 1] = drop
  last = model
until drop.broken or #drops >= falls

local function column(field)
  local values = {}
  for i, drop in ipairs(drops) do values[i] = drop[field] end
  return values
end
cdem.write_csv{ file = "drops.csv", columns = { { name = "height_m", values = column("height") },
                                                { name = "impact_velocity_m_per_s", values = column("velocity") },
                                                { name = "bonds_broken", values = column("bonds") },
                                                { name = "largest_piece", values = column("largest") },
                                                { name = "second_piece", values = column("second") },
                                                { name = "rebound_over_impact_velocity", values = column("rebound") } } }
cdem.chart{ file = "drops.png", title = "An armour unit dropped on a floor", x_label = "impact velocity (m/s)",
            y_label = "part of the unit", y_range = {0, 1},
            series = { { name = "largest piece", x = column("velocity"), y = column("largest"), style = "both" },
                       { name = "second piece", x = column("velocity"), y = column("second"), style = "both" } } }

local breaks_at = drops[#drops].broken and drops[#drops].height or nil
local pieces, frames, flown = {}, 4, 0
if breaks_at then
  for frame = 1, after > 0 and frames or 0 do
    last:run{ duration = after / frames }
    flown = math.max(flown, last:energy().balance_error)
    last:picture{ file = frame == frames and "broken.png" or string.format("flying_%d.png", frame), view = "iso", up = "z",
                  colour = "velocity.magnitude", deformation = 1, plain = {"floor"}, broken_bonds = not tough,
                  title = string.format("A fall of %.2g m: %.2g s after the touch", breaks_at, last.time) }
  end
  last:save{ file = "broken.vtu" }
  for _, piece in ipairs(last:fragments()) do
    if not piece.held and piece.volume > 0.01 * mesh:volume() then pieces[#pieces + 1] = piece.volume end
  end
end
local first_piece
for _, drop in ipairs(drops) do
  if drop.second >= 0.01 then
    first_piece = drop.velocity
    break
  end
end
local energy_error, penetration, off = flown, 0, 0
if breaks_at then penetration = last:contacts().deepest / H end
for _, drop in ipairs(drops) do
  energy_error = math.max(energy_error, drop.energy_error)
  penetration = math.max(penetration, drop.penetration)
  off = math.max(off, math.abs(drop.touch_velocity / drop.velocity - 1))
end
cdem.report{
  { name = "breaks_at_height_m", value = breaks_at, unit = "m" },
  { name = "breaks_at_velocity_m_per_s", value = breaks_at and math.sqrt(2 * g * breaks_at), unit = "m/s" },
  { name = "first_piece_of_a_hundredth_at_m_per_s", value = first_piece, unit = "m/s",
    reference = tension / (concrete.density * wave_speed), kind = "formula", source = "a bar that hits flat: T / rho c" },
  { name = "first_fall_bonds_broken", value = drops[1].bonds },
  { name = "first_fall_largest_piece", value = drops[1].largest },
  { name = "first_fall_rebound", value = drops[1].rebound },
  { name = "pieces_above_a_hundredth", value = pieces[1] and #pieces },
  { name = "touch_velocity_error", value = off, reference = 0, kind = "formula", source = "sqrt(2 g h)",
    tolerance_absolute = 1e-3 },
  { name = "max_penetration_over_height", value = penetration, reference = 0, kind = "formula",
    source = "nothing goes into the floor", tolerance_absolute = 0.01 },
  { name = "energy_balance_error", value = energy_error, reference = 0, kind = "formula", source = "energy is conserved",
    tolerance_absolute = 0.01 },
  { name = "tets", value = mesh.tets },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
