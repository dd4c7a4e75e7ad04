-- exit code: 2
-- says: a name that ends in .step, .stp, .stl,

local cdem = require "cdem"
cdem.solid.read{ file = "unit.iges" } -- wrong
