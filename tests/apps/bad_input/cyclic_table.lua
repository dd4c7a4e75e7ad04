-- exit code: 2
-- says: cycl

local cdem = require "cdem"
local loop = {}
loop.again = loop
cdem.model{ bodies = { loop } } -- wrong
