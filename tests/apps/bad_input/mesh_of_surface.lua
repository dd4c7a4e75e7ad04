-- exit code: 2
-- says: no tetrahedra; a mesh of volume elements is needed

local cdem = require "cdem"
cdem.read_mesh{ file = "surface.msh" } -- wrong
