-- exit code: 2
-- says: --set pressure=nan: must be a number
-- arguments: --set pressure=nan

local cdem = require "cdem"
cdem.parameter{ name = "pressure", default = 30e6, range = {0, 1e9} } -- wrong
