-- exit code: 2
-- says: stress[2]
-- says: finite

local model = require("plate").model()
model:traction{ on = "y+", stress = {0, -math.huge, 0} } -- wrong
