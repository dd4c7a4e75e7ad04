-- exit code: 4
-- says: not found beside the script

local cdem = require "cdem"
cdem.read_mesh{ file = "none.msh" } -- wrong
