-- exit code: 2
-- says: planes = 0: must be in [1, 15]

local model = require("plate").standing()
model:refine{ planes = 0 } -- wrong
