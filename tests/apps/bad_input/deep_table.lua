-- exit code: 2
-- says: deep

local cdem = require "cdem"
local deep = {}
for _ = 1, 1000000 do deep = { deep } end
cdem.model{ bodies = deep } -- wrong
