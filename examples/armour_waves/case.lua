-- Armour units on a slope of 1:1.5 under waves that grow: they are laid in one layer or more, come to rest in still water, and
-- then meet groups of regular waves, each group higher than the one before, with still water between them. After each group it
-- says how far every unit has moved, how far it rocked, and the damage N_od: units that left their places, by a nominal diameter
-- Dn at some time, per width of one Dn. Breakable units tell the share that broke, too.
--
--   ./cdem run examples/armour_waves/case.lua [--set units=50 --set columns=5] [--set drag=0.7]
--   ./cdem run examples/armour_waves/case.lua --set units=16 --set layers=2
--   ./cdem run examples/armour_waves/case.lua --set breakable=true --set tensile_strength=1e6
local cdem = require "cdem"

local count = cdem.parameter{ name = "units", default = 8, range = {8, 200}, doc = "how many" }
local layers = cdem.parameter{ name = "layers", default = 1, range = {1, 5}, doc = "which share the units" }
local columns = cdem.parameter{ name = "columns", default = 4, range = {2, 20}, doc = "units in a row" }
local seed = cdem.parameter{ name = "seed", default = 1, range = {0, 1e6}, doc = "of the attitudes: another layer" }
local mass = cdem.parameter{ name = "mass", default = 5000.0, range = {100, 1e5}, unit = "kg", doc = "of a unit" }
local first = cdem.parameter{ name = "first_ns", default = 2.5, range = {0.1, 10}, doc = "stability number of the first group" }
local step = cdem.parameter{ name = "ns_step", default = 0.5, range = {0.05, 5}, doc = "by which it grows" }
local groups = cdem.parameter{ name = "groups", default = 7, range = {1, 50}, doc = "at most" }
local highest_ns = cdem.parameter{ name = "highest_ns", default = 5.5, range = {0.1, 20},
                                     doc = "the sea is 2.2 times as deep as a wave of this number is high" }
local waves = cdem.parameter{ name = "waves", default = 1, range = {1, 1000}, doc = "in a group" }
local period = cdem.parameter{ name = "period", default = 8.0, range = {2, 30}, unit = "s", doc = "for 5 t; Froude scales it" }
local rest = cdem.parameter{ name = "rest", default = 3.0, range = {0, 1000}, unit = "s", doc = "still water after a group" }
local drag = cdem.parameter{ name = "drag", default = 1.0, range = {0, 10}, doc = "C_D" }
local added = cdem.parameter{ name = "added_mass", default = 0.5, range = {0, 5}, doc = "C_A" }
local roughness = cdem.parameter{ name = "friction_angle", default = 35.0, range = {0, 80}, unit = "deg",
                                  doc = "of units on each other, on the slope and on the walls" }
local friction = cdem.parameter{ name = "bed_friction", default = 0.05, range = {0, 1}, doc = "f of the slope" }
local modulus = cdem.parameter{ name = "youngs_modulus", default = 30e9, range = {1e8, 1e12}, unit = "Pa",
                                doc = "of the concrete; it sets the stiffness of contacts and the step of rigid units too" }
local deformable = cdem.parameter{ name = "deformable", default = false, doc = "units deform; false: rigid" }
local breakable = cdem.parameter{ name = "breakable", default = false, doc = "deformable, with the two below" }
local held = cdem.parameter{ name = "rigid_for", default = 0.0, range = {0, 1000}, unit = "s",
                             doc = "breakable units are rigid at first, until water comes; for 5 t, Froude scales it" }
local tension = cdem.parameter{ name = "tensile_strength", default = 3e6, range = {1e3, 1e9}, unit = "Pa" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 100.0, range = {0, 1e6}, unit = "J/m2",
                                  doc = "G_I; 0: brittle" }
local fineness = cdem.parameter{ name = "fineness", default = 3.0, range = {2, 20}, doc = "height over edge of the tetrahedra" }
local ends_at = cdem.parameter{ name = "ends_at", default = 2.0, range = {0.1, 100}, doc = "N_od at which it ends" }
local longest = cdem.parameter{ name = "time", default = 1e6, range = {0.01, 1e6}, unit = "s", doc = "of waves, at most" }
local draw = cdem.parameter{ name = "pictures", default = true, doc = "draw them" }
local film = cdem.parameter{ name = "film", default = 0.0, range = {0, 10}, unit = "s",
                             doc = "time between frames of a film; 0: none" }
local g, sea, gradient = 9.81, 1025, 1 / 1.5
if count % layers > 0 or count < layers * columns then
  error(string.format("units = %d: must be a multiple of layers = %d, with a row of %d in each", count, layers, columns))
end

local concrete = cdem.elastic{ youngs_modulus = modulus, poissons_ratio = 0.2, density = 2400, stiffness_damping = 1e-5 }
local solid = cdem.accropode{ mass = mass, density = concrete.density, width = 0.40, corner = 0 }
local unit, H = solid:mesh{ size = solid.height / fineness }, solid.height
local Dn = (mass / concrete.density) ^ (1 / 3)
local scale = (mass / 5000) ^ (1 / 6) -- Froude's law: times go with the root of lengths
period, rest, held = period * scale, rest * scale, held * scale
local length, width = (0.55 * math.ceil(count / layers / columns) + 2.5) * H, (1.4 * columns + 2) * H
local ground = cdem.slope{ gradient = gradient, length = length, width = width }:mesh{ size = 2 * H }
local pile = cdem.place{ unit = unit, count = count, layers = layers, columns = columns, onto = ground, seed = seed,
                         friction_angle = 12, walls = true }
local tough = toughness > 0
local joint = breakable and cdem.mohr_coulomb{ cohesion = 2 * tension, friction_angle = 35, tensile_strength = tension,
                                               softening = tough and "linear" or "none",
                                               fracture_energy_1 = tough and toughness or nil,
                                               fracture_energy_2 = tough and 10 * toughness or nil } or nil
local model = cdem.model{
  bodies = { { name = "units", shape = pile, material = concrete, joint = joint, bonds = joint and "cohesive" or nil },
             { name = "slope", shape = ground, material = concrete, element = "rigid" },
             { name = "walls", shape = pile:walls{ onto = ground }, material = concrete, element = "rigid" } },
  contacts = { default = cdem.coulomb{ friction_angle = roughness } } }
model:fix{ on = {"slope", "walls"} }
local lowest = {} -- rows of all layers: a layer's units follow those of the one below, its lowest row first
for layer = 0, layers - 1 do
  for column = 1, columns do lowest[#lowest + 1] = layer * (count // layers) + column end
end
model:fix{ on = cdem.select.units{ body = "units", numbers = lowest } }

-- Still water stands at the middle of the layer while it comes to rest.
local box = pile:box()
local level = 0.5 * (box.min[3] + box.max[3])
model:gravity{ vector = {0, 0, -g} }
model:flow{ on = "units", water = cdem.water.uniform{ velocity = {0, 0, 0}, level = level }, drag = drag, added_mass = added }
local settled = model:settle{ kinetic_energy_ratio = 1e-4, friction_angle = 15 }
if not (deformable or breakable) or held > 0 then model:make_rigid{ on = "units" } end
model:reset_displacement()

-- The slope goes on below the layer to deep water; the waves enter there.
local depth = 2.2 * highest_ns * (concrete.density / sea - 1) * Dn -- the same however many groups are planned
local toe = -(depth - level) / gradient
local bed = { {toe - 3 * Dn, level - depth}, {toe, level - depth}, {3 * length, 3 * length * gradient} }
local start, group_time = model.time, waves * period + rest
local ns, regular = {}, {}
for k = 1, groups do
  ns[k] = first + step * (k - 1)
  regular[k] = cdem.water.wave{ height = ns[k] * (concrete.density / sea - 1) * Dn, period = period, depth = depth,
                                level = level, crest_at = {toe - 3 * Dn, 0, 0} }
end
local function entering(time)
  local k = math.floor((time - start) / group_time) + 1
  local t = (time - start) - (k - 1) * group_time
  if k < 1 or k > groups or t > waves * period then return 0 end
  local grown = math.min(1, 2 * t / period, 2 * (waves * period - t) / period)
  return grown * (regular[k]:at({toe - 3 * Dn, 0, 0}, t - 0.25 * period).surface - level)
end
local water = cdem.water.slope{ bed = bed, level = level, waves = entering, friction = friction,
                                duration = start + groups * group_time + 1 }
model:clear_loads()
model:gravity{ vector = {0, 0, -g} }
-- Forces on the row that is held move nothing.
local is_held, free = {}, {}
for _, unit_number in ipairs(lowest) do is_held[unit_number] = true end
for i = 1, count do
  if not is_held[i] then free[#free + 1] = i end
end
model:flow{ on = cdem.select.units{ body = "units", numbers = free }, water = water, drag = drag, added_mass = added }

local function places() return model:pile{ body = "units" }:poses() end
local function picture(name, title)
  if draw then
    model:picture{ file = name, title = title, colour = "displacement.magnitude", range = {0, H}, plain = {"slope"},
                   hidden = {"walls"}, view = "iso", up = "z", deformation = 1, size = {1600, 0} }
  end
end
picture("rest.png", "At rest in still water")
if film > 0 then
  model:film{ file = "wave.ogv", every = film, colour = "displacement.magnitude", range = {0, H}, plain = {"slope"},
              hidden = {"walls"}, view = "iso", up = "z", size = {1600, 1000} }
end

local function broken_units() return model:pile{ body = "units" }.broken end
local function distance(from, to)
  local d2 = 0
  for axis = 1, 3 do d2 = d2 + (to.centroid[axis] - from.centroid[axis]) ^ 2 end
  return math.sqrt(d2)
end

local before, numbers, broken_at_rest = places(), {}, broken_units()
for i = 1, count do numbers[i] = i end
local rows = { ns = {}, nod = {}, largest = {}, out = {}, stayed_out = {}, mean = {}, rocked = {}, broken = {} }
local left, breaking, calls = {}, { time = {}, share = {} }, 0 -- left: units that were farther than Dn from their place
local function watch(start_of_group, farthest)
  for i, pose in ipairs(places()) do
    farthest[i] = math.max(farthest[i] or 0, distance(start_of_group[i], pose) / Dn)
    left[i] = left[i] or distance(before[i], pose) > Dn
  end
  calls = calls + 1
  if breakable and calls % 20 == 0 then
    local share, last = (broken_units() - broken_at_rest) / count, breaking.share[#breaking.share] or 0
    breaking.time[#breaking.time + 1], breaking.share[#breaking.share + 1] = model.time - start, share
    if share > last then cdem.log(string.format("%.2f s: %.0f %% of the units are broken", model.time - start, 100 * share)) end
  end
end
local columns_of_units, movements = { { name = "unit", values = numbers } }, {}
local first_out, damaged
local figures = {}
for k = 1, groups do
  local start_of_group, farthest = places(), {}
  local began = cdem.elapsed()
  local function run(duration)
    if duration > 0 then
      model:run{ duration = duration, every = 500, callback = function() watch(start_of_group, farthest) end }
    end
  end
  local duration = math.min(group_time, longest)
  local rigid = k == 1 and math.min(held, duration) or 0
  run(rigid)
  if rigid > 0 and (deformable or breakable) then model:make_deformable{ on = "units" } end
  run(duration - rigid)
  rows.wall_time = cdem.elapsed() - began
  watch(start_of_group, farthest)
  local largest, mean, rocked, gone, stayed_out, moved, rocking = 0, 0, 0, 0, 0, {}, {}
  for i, pose in ipairs(places()) do
    moved[i] = distance(before[i], pose) / Dn
    rocking[i] = (farthest[i] or 0) - distance(start_of_group[i], pose) / Dn -- it came back by as much
    largest, mean = math.max(largest, moved[i]), mean + moved[i] / count
    rocked = math.max(rocked, rocking[i])
    if left[i] then gone = gone + 1 end
    if moved[i] > 1 then stayed_out = stayed_out + 1 end
  end
  local nod = gone / ((box.max[2] - box.min[2]) / Dn)
  local broken = (broken_units() - broken_at_rest) / count
  local counts = model:counts()
  local faces = counts.broken_tension + counts.broken_shear
  rows.ns[k], rows.nod[k], rows.largest[k], rows.mean[k], rows.out[k] = ns[k], nod, largest, mean, gone
  rows.rocked[k], rows.broken[k], rows.stayed_out[k], rows.faces = rocked, broken, stayed_out, faces
  local at = string.format("ns_%g", ns[k])
  columns_of_units[#columns_of_units + 1] = { name = "movement_over_dn_" .. at, values = moved }
  columns_of_units[#columns_of_units + 1] = { name = "rocking_over_dn_" .. at, values = rocking }
  for name, value in pairs{ units_left = gone, n_od = nod, largest_movement_over_dn = largest, mean_movement_over_dn = mean,
                            largest_rocking_over_dn = rocked, units_broken = broken * count, faces_broken = faces } do
    figures[#figures + 1] = { name = name .. "_" .. at, value = value }
  end
  movements[k] = { name = string.format("Ns = %g", ns[k]), x = numbers, y = moved, style = "both" }
  cdem.log(string.format("Ns = %.2f, H = %.2f m: %d units have left, %d stayed away, N_od = %.2f, largest movement %.2f Dn, "
                         .. "mean %.3f Dn, rocking %.3f Dn%s", ns[k], ns[k] * (concrete.density / sea - 1) * Dn, gone,
                         stayed_out, nod, largest, mean, rocked,
                         breakable and string.format(", %.0f %% broken", 100 * broken) or ""))
  if gone > 0 and not first_out then
    first_out = ns[k]
    picture("first_out.png", string.format("The first unit has left: Ns = %.2f", ns[k]))
  end
  if nod >= 0.5 and not damaged then damaged = ns[k] end
  if nod >= ends_at or group_time > longest then break end
end
picture("end.png", "After the highest waves")
cdem.write_csv{ file = "groups.csv", columns = { { name = "ns", values = rows.ns }, { name = "n_od", values = rows.nod },
                                                 { name = "units_out", values = rows.out },
                                                 { name = "units_out_at_the_end", values = rows.stayed_out },
                                                 { name = "broken_share", values = rows.broken },
                                                 { name = "largest_movement_over_dn", values = rows.largest },
                                                 { name = "mean_movement_over_dn", values = rows.mean },
                                                 { name = "largest_rocking_over_dn", values = rows.rocked } } }
cdem.write_csv{ file = "units.csv", columns = columns_of_units }
cdem.chart{ file = "movement.png", title = "Movement of each unit since it came to rest", x_label = "unit",
            y_label = "movement / Dn", series = movements }
local series = { { name = "N_od", x = rows.ns, y = rows.nod, style = "both" },
                 { name = "largest movement", x = rows.ns, y = rows.largest, style = "both" },
                 { name = "start of damage of Accropodes 3.7 (Van der Meer 1988)", x = {3.7, 3.7}, y = {0, 1}, style = "dashed" },
                 { name = "failure 4.1", x = {4.1, 4.1}, y = {0, 1}, style = "dashed" } }
if breakable then series[#series + 1] = { name = "share of broken units", x = rows.ns, y = rows.broken, style = "both" } end
cdem.chart{ file = "damage.png", title = "Damage under growing waves", x_label = "Ns = H / (Delta Dn)",
            y_label = "N_od; movement over Dn", series = series }
if #breaking.time > 1 then
  cdem.chart{ file = "breaking.png", title = "Units that are broken", x_label = "time (s)", y_label = "share",
              series = { { name = "broken", x = breaking.time, y = breaking.share } } }
end
table.sort(figures, function(a, b) return a.name < b.name end)
cdem.report(figures)
cdem.report{
  { name = "kinetic_ratio_at_rest", value = settled.kinetic_ratio },
  { name = "first_unit_out_ns", value = first_out, reference = 3.7, kind = "paper",
    source = "Van der Meer 1988: start of damage of Accropodes" },
  { name = "damage_ns", value = damaged, reference = 4.1, kind = "paper", source = "Van der Meer 1988: failure" },
  { name = "broken_share", value = breakable and rows.broken[#rows.broken] or nil },
  { name = "faces_broken", value = breakable and rows.faces or nil },
  { name = "run_up", value = water.run_up - level, unit = "m" },
  { name = "run_down", value = water.run_down - level, unit = "m" },
  { name = "deepest_contact_over_height", value = model:contacts().deepest / H, reference = 0, kind = "formula",
    source = "nothing passes through", tolerance_absolute = 0.01 },
  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 0.01 },
  { name = "tets_per_unit", value = unit.tets },
  { name = "wall_time_of_last_group_s", value = rows.wall_time, unit = "s" },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
