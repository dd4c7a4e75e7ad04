-- exit code: 2
-- says: cohesion = -1: must be >= 0

local cdem = require "cdem"
cdem.mohr_coulomb{ cohesion = -1, friction_angle = 30, tensile_strength = 5e6 } -- wrong
