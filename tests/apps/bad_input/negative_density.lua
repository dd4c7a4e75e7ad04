-- exit code: 2
-- says: density = -2500: must be > 0

local cdem = require "cdem"
cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = -2500 } -- wrong
