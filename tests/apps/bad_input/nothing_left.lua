-- exit code: 2
-- says: cut: nothing is left

local cdem = require "cdem"
local cube = cdem.cube{ height = 1 }
cdem.solid.cut{ solid = cube, tools = { cube } } -- wrong
