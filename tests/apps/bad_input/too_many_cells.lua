-- exit code: 2
-- says: count = 1000000000

local cdem = require "cdem"
cdem.voronoi{ size = {1, 1, 1}, count = 1000000000, seed = 1 } -- wrong
