-- exit code: 2
-- says: density: missing

local cdem = require "cdem"
cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25 } -- wrong
