-- An armour unit falls, overturns or swings from heights that close in on the one from which it breaks. The height is that by
-- which its centre of mass comes down. Each time the unit is whole again and starts just before the impact with the velocity
-- that it has by then.
--
--   ./cdem run examples/drop_test/case.lua --set shape=cubipod --set attitude=corner
--   ./cdem run examples/drop_test/case.lua --set floor=rigid --set fracture_energy=0
--   ./cdem run examples/drop_test/case.lua --set test=overturning --set shape=dolos --set low=0.002
--   ./cdem run examples/drop_test/case.lua --set test=pendulum --set target=unit --set film=30
local cdem = require "cdem"
local place = require "place"

local test = cdem.parameter{ name = "test", default = "drop", choices = {"drop", "overturning", "pendulum"},
                             doc = "overturning: it stands as built and falls over about its lower edge; pendulum: it swings" }
local shape = cdem.parameter{ name = "shape", default = "cube", choices = {"cube", "cubipod", "dolos", "tetrapod", "accropode"} }
local attitude = cdem.parameter{ name = "attitude", default = "flat", choices = {"flat", "edge", "corner"},
                                 doc = "of a fall or a swing: what strikes first" }
local heading = cdem.parameter{ name = "heading", default = 0.0, range = {-360, 360}, unit = "deg",
                                doc = "turns the unit about the vertical before it overturns towards x" }
local target = cdem.parameter{ name = "target", default = "block", choices = {"block", "unit"},
                               doc = "of a swing: a wide block like the floor, or a unit of the same shape as built" }
local mass = cdem.parameter{ name = "mass", default = 16000.0, range = {1, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 5.0, range = {2, 30}, doc = "Dn over edge of the tets" }
local tension = cdem.parameter{ name = "tensile_strength", default = 3e6, range = {1e4, 1e9}, unit = "Pa" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 100.0, range = {0, 1e6}, unit = "J/m2",
                                  doc = "G_I; 0: springs, brittle" }
local rate = cdem.parameter{ name = "rate_effect", default = false,
                             doc = "strength grows with the rate of strain, fib Model Code 2010; wants G_I above 0" }
local floor = cdem.parameter{ name = "floor", default = "concrete", choices = {"concrete", "rigid"} }
local stiff = cdem.parameter{ name = "contact_stiffness", default = 1.0, range = {1e-3, 1e3},
                              doc = "of what touches, over that of the tets; 1: what the program takes" }
local low = cdem.parameter{ name = "low", default = 0.05, range = {1e-3, 100}, unit = "m", doc = "first height" }
local turns = cdem.parameter{ name = "bisections", default = 4, range = {0, 20}, doc = "after the height is between two" }
local most = cdem.parameter{ name = "most", default = 60.0, range = {0.1, 1e4}, unit = "m", doc = "gives up there" }
local draw = cdem.parameter{ name = "pictures", default = true, doc = "draw the unit that breaks" }
local film = cdem.parameter{ name = "film", default = 0, range = {0, 1000}, doc = "its frames while the pieces fly: breaks.ogv" }
local after = cdem.parameter{ name = "after", default = 0.1, range = {0.01, 10}, unit = "s", doc = "how long the pieces fly on" }

local g, density = 9.81, 2400
-- All is meshed for 16 t and scaled: another size has the same tetrahedra, and what differs is not the mesh.
local built, scale = (16000 / density) ^ (1 / 3), (mass / 16000) ^ (1 / 3)
local size = scale * built -- nominal diameter
local function mesh_of(solid, name, coarser)
  local mesh = solid:mesh{ size = built / fineness * (coarser or 1) }
  if scale == 1 then return mesh end
  mesh:save{ file = name .. ".vtu" }
  return cdem.read_mesh{ file = name .. ".vtu", scale = scale }
end
-- Damping grows with the size, as times do: a brittle unit then breaks from the same height at any size.
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = density, stiffness_damping = 5e-7 * size }
local wave_speed = math.sqrt(concrete.youngs_modulus / concrete.density)
local make = { cube = cdem.cube, cubipod = cdem.cubipod, dolos = cdem.dolos, tetrapod = cdem.tetrapod,
               accropode = cdem.accropode }
local as_built = make[shape]{ mass = 16000, density = concrete.density }
local unit = as_built
if attitude == "edge" then unit = unit:rotate{ axis = {1, 0, 0}, angle = 45 } end
if attitude == "corner" then unit = unit:rotate{ axis = {1, -1, 0}, angle = math.deg(math.atan(math.sqrt(2))) } end
local gap = 1e-3 * built
local over, other
if test == "overturning" then
  over = place.overturning(as_built:rotate{ axis = {0, 0, 1}, angle = heading }, built, shape == "tetrapod")
  unit = over.at(over.angle - math.deg(1e-3)) -- what strikes is about a gap above the floor
elseif test == "pendulum" then
  unit = place.hanging(unit, gap)
  if target == "unit" then
    other = as_built:translate{ shift = {-as_built:box().min[1], 0, 0} }
    unit = place.before(unit, other, gap)
  end
else
  unit = unit:translate{ shift = {0, 0, gap - unit:box().min[3]} }
end
if over then unit = unit:translate{ shift = {0, 0, -unit:mesh{ size = built / fineness }:box().min[3]} } end
local box, mesh = unit:box(), mesh_of(unit, "unit")
local across, normal = 1, 3 -- axes along and into what is struck: a floor, or a block that stands in front
if test == "pendulum" then across, normal = 3, 1 end
local reach = 1.5 * math.max(box.max[across] - box.min[across], box.max[2] - box.min[2])
local thick = floor == "rigid" and 0.2 * built or 0.5 * built
local extent, origin, back, into = {reach, reach, reach}, {}, {0, 0, 0}, {0, 0, 0}
for axis = 1, 3 do origin[axis] = (box.min[axis] + box.max[axis] - reach) / 2 end
extent[normal], origin[normal] = thick, test == "pendulum" and 0 or -thick
back[normal], into[normal] = test == "pendulum" and thick or -thick, 1
local struck_mesh = other and mesh_of(other, "struck") or mesh_of(cdem.solid.box{ size = extent, origin = origin }, "floor", 1.5)
gap, back[normal] = gap * scale, back[normal] * scale
if over then place.scale(over, scale) end
local tough = toughness > 0
local joint = cdem.mohr_coulomb{ cohesion = 2 * tension, friction_angle = 35, tensile_strength = tension,
                                 softening = tough and "linear" or "none", fracture_energy_1 = tough and toughness or nil,
                                 fracture_energy_2 = tough and 10 * toughness or nil,
                                 rate_effect = rate and { reference_rate = 1e-6, exponent = 0.018, change_rate = 10,
                                                          exponent_above = 1 / 3 } or nil }
local rough = cdem.coulomb{ friction_angle = 35 }
local strike = rough
if stiff ~= 1 then -- over the two tets in series, regular ones; a rigid body has none
  local height = 0.816 * size / fineness * (other and 2 or floor == "rigid" and 1 or 2.5)
  strike = cdem.coulomb{ friction_angle = 35, normal_stiffness = stiff * concrete.youngs_modulus / height }
end
local bonds = tough and "cohesive" or "springs"
local struck = other and { shape = struck_mesh, material = concrete, joint = joint, name = "struck", bonds = bonds }
               or { shape = struck_mesh, material = concrete, element = floor == "rigid" and "rigid" or nil, name = "floor" }
local contacts = { { struck.name, "unit", strike }, { "unit", "unit", rough } }
if other then contacts[3] = { "struck", "struck", rough } end

-- Velocity of the centre of mass after a height; an overturning unit turns about its lower edge.
local function velocity_after(height)
  return over and over.arm * math.sqrt(2 * over.mass * g * height / over.inertia) or math.sqrt(2 * g * height)
end

-- Lets it fall; returns whether a tenth of a unit has come off, and the model.
local worst_energy, worst_given, falls, faces_in_zone = 0, 0, {}, nil
local function fall(height, filmed)
  local model = cdem.model{
    bodies = { struck, { shape = mesh, material = concrete, joint = joint, name = "unit", bonds = bonds } }, contacts = contacts }
  for _, zone in ipairs(tough and model:process_zones() or {}) do
    if zone.of:find("unit", 1, true) then faces_in_zone = zone.faces_in_zone end
  end
  if not other then
    if floor == "rigid" then
      model:fix{ on = "floor" }
    else -- wide, on the ground or against it: waves leave it at its back
      model:quiet{ on = cdem.select.plane{ point = back, normal = into } }
    end
  end
  if test ~= "pendulum" then model:gravity{ vector = {0, 0, -g} } end -- ropes carry the weight of one that swings
  local so_far = test == "drop" and math.max(0, height - gap) or height
  local start = velocity_after(so_far)
  if over then
    model:initial_velocity{ on = "unit", velocity = {0, 0, 0}, angular_velocity = {0, start / over.arm, 0}, about = over.edge }
  else
    model:initial_velocity{ on = "unit", velocity = test == "pendulum" and {start, 0, 0} or {0, 0, -start} }
  end
  for _, piece in ipairs(model:fragments()) do
    if piece.body == "unit" then
      worst_given = math.max(worst_given, math.abs(piece.kinetic_energy / (piece.mass * g * so_far) - 1))
    end
  end
  if filmed then
    model:film{ file = "breaks.ogv", every = after / film, view = "iso", up = "z", colour = "fragment", plain = {"floor"} }
  end
  local touches = over and start / over.arm * size or start -- with this velocity
  model:run{ duration = 2 * gap / (touches + (test == "drop" and velocity_after(height) or touches)) + 30 * size / wave_speed }
  local left = { unit = 0, struck = other and 0 or nil }
  for _, piece in ipairs(model:fragments()) do
    if left[piece.body] then left[piece.body] = math.max(left[piece.body], piece.volume) end
  end
  local largest = math.min(left.unit / mesh:volume(), (left.struck or math.huge) / struck_mesh:volume())
  local counts = model:counts()
  worst_energy = math.max(worst_energy, model:energy().balance_error)
  falls[#falls + 1] = { height = height, largest = largest }
  cdem.log(string.format("%s of a %s, %s, %.3g m, %.3g m/s: %d springs broken, the largest piece %.3g of the unit", test, shape,
                         over and "as built" or attitude, height, velocity_after(height),
                         counts.broken_tension + counts.broken_shear, largest))
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

if broken and film > 0 then
  local _, model = fall(broken, true)
  last = model
end
local way = { drop = "a fall", overturning = "overturning", pendulum = "a swing" }
for frame = 1, broken and (draw or film > 0) and 3 or 0 do
  last:run{ duration = after / 3 }
  if draw then
    last:picture{ file = string.format("breaks_%d.png", frame), view = "iso", up = "z", colour = "velocity.magnitude",
                  deformation = 1, plain = {"floor"},
                  title = string.format("%s%s, %s of %.2g m: %.2g s after the touch", shape, over and "" or ", " .. attitude,
                                        way[test], broken, last.time) }
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
  { name = "critical_velocity_over_t_by_rho_c", value = critical and velocity_after(critical) * concrete.density * wave_speed
                                                        / tension },
  { name = "critical_tilt_deg", value = over and critical and place.tilt(over, critical), unit = "deg",
    source = "back from the touch; none where it is beyond balance" },
  { name = "height_from_balance_m", value = over and place.balance_height(over), unit = "m" },
  { name = "kinetic_energy_error", value = worst_given, reference = 0, kind = "formula", tolerance_absolute = 1 / fineness ^ 2,
    source = "m g h just before the impact; the mesh's mass is at its nodes" },
  { name = "energy_balance_error", value = worst_energy, reference = 0, kind = "formula", source = "energy is conserved",
    tolerance_absolute = 0.02 },
  { name = "tets", value = mesh.tets },
  { name = "faces_in_process_zone", value = faces_in_zone, source = "three resolve it" },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
