-- exit code: 3
-- says: run-away
-- says: step
-- says: block

local cdem = require "cdem"
local plate = require "plate"
local model = cdem.model{ bodies = { { shape = plate.shape, material = plate.rock, joint = plate.joint } } }
model:traction{ on = "y+", stress = {0, 1e6, 0} } -- nothing holds it
model:run{ duration = 10 } -- wrong
