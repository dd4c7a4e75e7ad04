-- exit code: 2
-- says: divisions[2] = 0: must be >= 1

local cdem = require "cdem"
cdem.grid{ size = {0.3, 0.3, 0.03}, divisions = {10, 0, 1} } -- wrong
