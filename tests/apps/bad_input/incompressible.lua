-- exit code: 2
-- says: poissons_ratio = 0.5: must be in (-1, 0.5)

local cdem = require "cdem"
cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.5, density = 2500 } -- wrong
