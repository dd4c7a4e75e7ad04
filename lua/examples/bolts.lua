local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
local shape = cdem.cut_by_plane{ shape = cdem.box{ size = {4, 1, 1} }, point = {2, 0, 0}, normal = {1, 0, 0}, name = "crack" }
local model = cdem.model{ bodies = { { name = "rock", shape = shape, material = rock,
                                       joint = cdem.coulomb{ friction_angle = 30 } } } }
model:fix{ on = "x-" }

-- example: model:bolts
local count = model:bolts{ from = {0.2, 0.5, 0.5}, to = {3.8, 0.5, 0.5}, area = 4.9e-4, yield_stress = 500e6,
                           grout_stiffness = 5e8, grout_strength = 2e5 }
model:force{ on = "x+", force = {5e4, 0, 0} } -- the bolt alone holds the right block
model:relax{ residual = 1e-4 }
print(count)

-- example: model:bolt_forces
local largest = 0
for _, node in ipairs(model:bolt_forces()) do largest = math.max(largest, node.tension) end
print(largest) -- N, 5e4 at the crack

-- example: model:save_bolts
model:save_bolts{ file = "bolts.csv" }
