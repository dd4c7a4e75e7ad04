-- exit code: 2
-- says: takes one table

local cdem = require "cdem"
cdem.grid({1, 1, 1}, {2, 2, 2}) -- wrong
