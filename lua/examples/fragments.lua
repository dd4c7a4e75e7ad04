local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
local floor = cdem.solid.box{ size = {6, 6, 1}, origin = {0, 0, -1} }:mesh{ size = 1 }
local pile = cdem.drop{ unit = unit, count = 3, onto = floor }
local model = cdem.model{ bodies = { { name = "units", shape = pile, material = concrete },
                                     { name = "floor", shape = floor, material = concrete } },
                          contacts = { default = cdem.coulomb{ friction_angle = 35 } } }
model:fix{ on = "floor" }
model:gravity{ vector = {0, 0, -9.81} }
model:settle{ kinetic_energy_ratio = 1e-2, max_time = 5 }

-- example: model:fragments
local largest_free
for _, fragment in ipairs(model:fragments()) do
  if not fragment.held then
    print(fragment.mass, fragment.velocity[3])
    largest_free = largest_free or fragment
  end
end

-- example: model:save_fragments
model:save_fragments{ file = "fragments.csv" }

-- example: model:pile
local settled = model:pile{ body = "units" }
settled:save{ file = "settled.json" } -- the next script reads it

-- example: model:pile_measures
local slope = cdem.slope{ gradient = 1 / 1.5, length = 12, width = 10 }:mesh{ size = 2 }
local layer = cdem.place{ unit = unit, count = 40, onto = slope, attitudes = 20, nudges = 0 }
local armour = cdem.model{ bodies = { { name = "units", shape = layer, material = concrete },
                                      { name = "slope", shape = slope, material = concrete } },
                           contacts = { default = cdem.coulomb{ friction_angle = 35 } } }
local measures = armour:pile_measures{ body = "units", onto = "slope" }
print(measures.porosity, measures.units_per_area_times_dn2)

-- example: model:contacts
print(model:contacts().acting)

-- example: model:lowest_units model:highest_units
print(model:lowest_units{ body = "units", count = 1 }[1])
print(model:highest_units{ body = "units", count = 1 }[1])
