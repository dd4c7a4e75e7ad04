-- exit code: 2
-- says: garbled.step

local cdem = require "cdem"
cdem.solid.read{ file = "garbled.step" } -- wrong
