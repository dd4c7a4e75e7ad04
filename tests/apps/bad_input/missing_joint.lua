-- exit code: 2
-- says: bodies[1].joint: missing
-- says: cdem.mohr_coulomb

local cdem = require "cdem"
local plate = require "plate"
cdem.model{ bodies = { { shape = plate.shape, material = plate.rock } } } -- wrong
