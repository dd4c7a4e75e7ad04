-- exit code: 2
-- says: --set pressure=high: must be a number
-- arguments: --set pressure=high

local cdem = require "cdem"
cdem.parameter{ name = "pressure", default = 30e6, range = {0, 1e9} } -- wrong
