-- exit code: 2
-- says: the joint inside "plate" softens

local cdem = require "cdem"
local plate = require "plate"
local soft = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6, softening = "linear",
                                fracture_energy_1 = 1000, fracture_energy_2 = 4000 }
local model = cdem.model{ bodies = { { shape = plate.shape, material = plate.rock, joint = soft, name = "plate" } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {0, -1e6, 0} }
model:grow{} -- wrong
