-- exit code: 2
-- says: --set pressure = -1
-- says: [0, 1e+09]
-- arguments: --set pressure=-1

local cdem = require "cdem"
cdem.parameter{ name = "pressure", default = 30e6, range = {0, 1e9} } -- wrong
