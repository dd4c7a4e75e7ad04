-- exit code: 2
-- says: node 3 is at {0, nan, 0}
-- says: every coordinate must be a finite number

local cdem = require "cdem"
cdem.read_mesh{ file = "nan_node.msh" } -- wrong
