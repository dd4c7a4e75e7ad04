-- exit code: 2
-- says: shear_threshold = -1: must be >= 0

local model = require("plate").standing()
model:refine{ shear_threshold = -1 } -- wrong
