-- A small breakwater: one layer of armour units is laid on a slope, comes to rest, and a flow that grows throws units out.
--
--   ./cdem run examples/breakwater/case.lua [--set count=20] [--set mass=9000] [--set wanted=3]
local cdem = require "cdem"

local count = cdem.parameter{ name = "count", default = 12, range = {8, 100}, doc = "units" }
local columns = cdem.parameter{ name = "columns", default = 3, range = {2, 20}, doc = "units in a row" }
local mass = cdem.parameter{ name = "mass", default = 5000.0, range = {100, 1e5}, unit = "kg", doc = "of a unit" }
local wanted = cdem.parameter{ name = "wanted", default = 1, range = {1, 10}, doc = "ends when so many units have left" }
local g, water, gradient = 9.81, 1025, 1 / 1.5

-- A unit, and the slope it is laid on.
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400, stiffness_damping = 1e-5 }
local solid = cdem.accropode{ mass = mass, density = concrete.density, width = 0.40, corner = 0 }
local unit, height = solid:mesh{ size = solid.height / 3 }, solid.height
local length = (0.55 * math.ceil(count / columns) + 2.5) * height
local slope = cdem.slope{ gradient = gradient, length = length, width = (1.4 * columns + 2) * height }:mesh{ size = 2 * height }
local pile = cdem.place{ unit = unit, count = count, columns = columns, onto = slope, friction_angle = 12, walls = true }

-- Walls at both sides, on which the ends of the rows lean, and at the toe.
local model = cdem.model{
  bodies = { { name = "units", shape = pile, material = concrete },
             { name = "slope", shape = slope, material = concrete, element = "rigid" },
             { name = "walls", shape = pile:walls{ onto = slope }, material = concrete, element = "rigid" } },
  contacts = { default = cdem.coulomb{ friction_angle = 35 } } }
model:fix{ on = {"slope", "walls"} }
local lowest = cdem.select.units{ body = "units", numbers = model:lowest_units{ body = "units", count = columns } }
model:fix{ on = lowest }
model:gravity{ vector = {0, 0, -g}, water_density = water }

-- The units come to rest, with little friction at first so that each leans on three others.
local rest = model:settle{ kinetic_energy_ratio = 1e-4, friction_angle = 15 }
local function draw(name, title, field, range)
  model:picture{ file = name, title = title, colour = field, range = range, colour_bar = field ~= "unit", plain = {"slope"},
                 hidden = {"walls"}, view = "iso", up = "z", deformation = 1, size = {1600, 0} }
end
draw("settled.png", "At rest", "unit")
local measures = model:pile_measures{ body = "units", onto = "slope" }
model:pile{ body = "units" }:save{ file = "pile.json" }

-- The flow runs up the slope. It starts at 3 m/s and grows by 2 m/s each second.
model:reset_displacement()
local left, start = model:watch{ body = "units", leaves = 0.5 * height }, model.time
model:flow{ on = "units", direction = {1, 0, gradient}, water_density = water,
            velocity = function(time) return 3 + 2 * (time - start) end }
model:run{ duration = 8, stop = function() return #left >= wanted end }
draw("leaves.png", "The first units have left", "displacement.magnitude", {0, height})

local figures = { { name = "kinetic_ratio_at_rest", value = rest.kinetic_ratio },
                  { name = "packing_density", value = measures.units_per_area_times_dn2 },
                  { name = "deepest_contact_over_height", value = model:contacts().deepest / height, reference = 0,
                    kind = "formula", source = "nothing passes through", tolerance_absolute = 0.01 },
                  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
                    source = "energy is conserved", tolerance_absolute = 0.01 },
                  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" } }
for k, departure in ipairs(left) do
  figures[#figures + 1] = { name = "unit_" .. k .. "_leaves_at", value = departure.velocity, unit = "m/s" }
end
cdem.report(figures)
