-- exit code: 2
-- says: must be one closed surface; it is open
-- says: edges belong to one triangle only

local cdem = require "cdem"
cdem.solid.read{ file = "open.stl" } -- wrong
