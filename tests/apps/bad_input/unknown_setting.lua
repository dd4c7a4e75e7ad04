-- exit code: 2
-- says: presure
-- says: did you mean pressure?
-- arguments: --set presure=24e6

local cdem = require "cdem"
cdem.parameter{ name = "pressure", default = 30e6, range = {0, 1e9} }
