-- exit code: 2
-- says: youngs_modulus
-- says: finite

local cdem = require "cdem"
cdem.elastic{ youngs_modulus = 0/0, poissons_ratio = 0.25, density = 2500 } -- wrong
