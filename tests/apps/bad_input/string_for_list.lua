-- exit code: 2
-- says: bodies
-- says: list

local cdem = require "cdem"
cdem.model{ bodies = "plate" } -- wrong
