-- exit code: 2
-- says: bonds = "cohesive" softens

local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} }
local soft = cdem.mohr_coulomb{ cohesion = 5e6, friction_angle = 35, tensile_strength = 2e6, softening = "linear",
                                fracture_energy_1 = 100, fracture_energy_2 = 400 }
cdem.model{ bodies = { { shape = mesh, material = concrete, joint = soft, bonds = "springs" } } } -- wrong
