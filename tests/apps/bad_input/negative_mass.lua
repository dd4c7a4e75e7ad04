-- exit code: 2
-- says: mass = -5000: must be > 0

local cdem = require "cdem"
cdem.accropode{ mass = -5000, density = 2500 } -- wrong
