local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
local shape = cdem.cut_by_joints{ shape = cdem.box{ size = {10, 10, 10} }, sets = {
  { name = "bedding", dip = 10, dip_direction = 90, spacing = 4 } } }
local model = cdem.model{ bodies = { { name = "rock", shape = shape, material = rock,
                                       joint = cdem.coulomb{ friction_angle = 40 } } } }
for _, side in ipairs{ "x", "y" } do model:fix{ on = { side .. "-", side .. "+" }, axes = side } end
model:fix{ on = "z-" }
model:gravity{ vector = {0, 0, -9.81} }

-- example: model:water
model:water{ level = 6 }                                   -- hydrostatic below z = 6 m, in all joints
model:water{ joints = {"bedding"}, table = { {0, 4e4}, {6, 0} } } -- or rows of {z, pressure}
model:water{ pressure = 0 }                                -- drained

-- example: cdem.water_table watertable:height
local table = cdem.water_table{ point = {0, 0, 5}, dip = 8, dip_direction = 90 } -- falls towards +x
local drawn = cdem.water_table{ profile = { {0, 6}, {4, 5}, {10, 3} }, direction = {1, 0, 0} } -- {distance, z}
local holes = cdem.water_table{ points = { {-1, -1, 6}, {11, -1, 4}, {5, 11, 5} } } -- levels in boreholes
print(table:height(2, 0), drawn:height(2, 0), holes:height(2, 0))
model:water{ water_table = drawn }
model:water{ pressure = 0 }

-- example: model:initial_stress
model:initial_stress{ gradient = rock.density * 9.81, k0 = 0.5 } -- from the surface downwards

-- example: model:unbalance
print(model:unbalance{}.largest) -- near 0: the stress fits the weight

-- example: model:gravity_stress
model:gravity_stress{ residual = 1e-4 } -- instead of initial_stress: by relaxation

-- example: model:reset_displacement
model:reset_displacement() -- results count from here
print(model:max("displacement.magnitude")) -- 0
