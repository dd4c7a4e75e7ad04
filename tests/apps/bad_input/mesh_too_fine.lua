-- exit code: 2
-- says: at most 20 million tetrahedra

local cdem = require "cdem"
cdem.cube{ height = 1 }:mesh{ size = 1e-3 } -- wrong
