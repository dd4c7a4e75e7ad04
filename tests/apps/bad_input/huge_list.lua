-- exit code: 2
-- says: size
-- says: three numbers

local cdem = require "cdem"
local many = {}
for i = 1, 100000 do many[i] = 1 end
cdem.grid{ size = many, divisions = {1, 1, 1} } -- wrong
