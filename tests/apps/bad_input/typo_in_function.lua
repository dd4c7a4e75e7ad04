-- exit code: 2
-- says: cdem.elastics
-- says: did you mean elastic?

local cdem = require "cdem"
cdem.elastics{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 } -- wrong
