-- exit code: 2
-- says: joint: missing; bonds = "springs"

local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} }
cdem.model{ bodies = { { shape = mesh, material = concrete, bonds = "springs" } } } -- wrong
