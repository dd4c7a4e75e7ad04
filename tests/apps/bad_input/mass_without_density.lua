-- exit code: 2
-- says: density: missing; give the height, or mass and density

local cdem = require "cdem"
cdem.accropode{ mass = 5000 } -- wrong
