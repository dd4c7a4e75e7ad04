-- exit code: 2
-- says: size
-- says: must be
-- says: "0.3"

local cdem = require "cdem"
cdem.grid{ size = "0.3", divisions = {1, 1, 1} } -- wrong
