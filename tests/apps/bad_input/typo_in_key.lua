-- exit code: 2
-- says: youngs_modulos
-- says: did you mean youngs_modulus?

local cdem = require "cdem"
cdem.elastic{ youngs_modulos = 30e9, poissons_ratio = 0.25, density = 2500 } -- wrong
