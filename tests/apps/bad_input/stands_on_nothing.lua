-- exit code: 3
-- says: run-away
-- says: supports

local model = require("plate").model()
model:traction{ on = "y+", stress = {0, -1e6, 0} }
model:relax{} -- wrong
