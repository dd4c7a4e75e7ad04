-- exit code: 3
-- says: run-away
-- says: step
-- says: block

local cdem = require "cdem"
local plate = require "plate"
local loose = cdem.coulomb{ friction_angle = 0 }
local model = cdem.model{ bodies = { { shape = plate.shape, material = plate.rock, joint = loose } } }
model:traction{ on = "y+", stress = {0, 1e9, 0} }
model:run{ duration = 10 } -- wrong
