-- exit code: 2
-- says: bodies

local cdem = require "cdem"
cdem.model{ bodies = {} } -- wrong
