-- exit code: 2
-- says: nothing

local cdem = require "cdem"
local model = require("plate").model()
model:fix{ on = cdem.select.plane{ point = {0, 5, 0}, normal = {0, 1, 0} } } -- wrong
