-- exit code: 2
-- says: friction_angle = 90: must be in [0, 90)

local cdem = require "cdem"
cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 90, tensile_strength = 5e6 } -- wrong
