local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }

-- example: cdem.model
local model = cdem.model{
  bodies = { { name = "wall", shape = cdem.bricks{ size = {2, 0.25, 1}, brick = {0.5, 0.25, 0.25} }, material = rock,
               joint = joint },
             { name = "ball", shape = cdem.solid.sphere{ radius = 0.2, centre = {1, 0.1, 1.3} }:mesh{ size = 0.05 },
               material = rock, element = "rigid" } },
  contacts = { {"wall", "ball", cdem.coulomb{ friction_angle = 30 }}, default = cdem.coulomb{ friction_angle = 20 } } }

-- example: model:select
model:select{ name = "foot", on = cdem.select.box{ min = {0, 0, 0}, max = {2, 0.25, 0.25} } }
model:fix{ on = "foot" }

-- example: model:counts
local counts = model:counts()
print(counts.blocks, counts.tets, counts.bonds)

-- example: model:process_zones
local soft = cdem.mohr_coulomb{ cohesion = 9e6, friction_angle = 30, tensile_strength = 3e6, softening = "linear",
                                fracture_energy_1 = 100, fracture_energy_2 = 1000 }
local beam = cdem.model{ bodies = { { name = "beam", shape = cdem.box_mesh{ size = {1, 0.2, 0.1}, divisions = {20, 4, 2} },
                                      material = rock, joint = soft } } }
print(beam:process_zones()[1].faces_in_zone) -- three or more resolve the crack's cohesive zone

-- example: model:box
print(model:box().max[3]) -- 1.5 m
