-- exit code: 2
-- says: size[1] = 0: must be > 0

local cdem = require "cdem"
cdem.grid{ size = {0, 0.3, 0.03}, divisions = {10, 10, 1} } -- wrong
