-- exit code: 2
-- says: bar = 0.6: must be from 0.1 to 0.45

local cdem = require "cdem"
cdem.accropode{ height = 1, bar = 0.6 } -- wrong
