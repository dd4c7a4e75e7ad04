-- exit code: 2
-- says: points
-- says: plane

local cdem = require "cdem"
cdem.convex_hull{ points = { {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 0} } } -- wrong
