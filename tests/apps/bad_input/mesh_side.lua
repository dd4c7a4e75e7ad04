-- exit code: 2
-- says: side = "w+"
-- says: must be one of "x-", "x+"

local cdem = require "cdem"
local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
mesh:faces{ side = "w+" } -- wrong
