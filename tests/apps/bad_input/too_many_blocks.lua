-- exit code: 2
-- says: {1000, 1000, 1000}
-- says: blocks

local cdem = require "cdem"
cdem.grid{ size = {1, 1, 1}, divisions = {1000, 1000, 1000} } -- wrong
