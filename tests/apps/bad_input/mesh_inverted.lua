-- exit code: 2
-- says: tetrahedron 1 near {0.25, 0.25, 0.25} is inverted
-- says: mesh anew

local cdem = require "cdem"
cdem.read_mesh{ file = "inverted.msh" } -- wrong
