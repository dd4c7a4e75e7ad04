-- exit code: 2
-- says: bodies[2].name = "plate": must be unique

local cdem = require "cdem"
local plate = require "plate"
local body = { shape = plate.shape, material = plate.rock, joint = plate.joint, name = "plate" }
cdem.model{ bodies = { body, body } } -- wrong
