-- exit code: 2
-- says: touch and no contact between them is given

local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} }
local slope = cdem.box{ size = {1, 1, 1}, origin = {0, 0, -1} }
cdem.model{ bodies = { { shape = mesh, material = concrete }, { shape = slope, material = concrete } } } -- wrong
