-- exit code: 2
-- says: lower
-- says: upper
-- says: contacts

local cdem = require "cdem"
local plate = require "plate"
local lower, upper = cdem.box{ size = {1, 1, 1} }, cdem.box{ size = {1, 1, 1}, origin = {0, 1, 0} }
cdem.model{ bodies = { { shape = lower, material = plate.rock, name = "lower" }, -- wrong
                       { shape = upper, material = plate.rock, name = "upper" } } }
