-- exit code: 2
-- says: break_ratio = 0

local model = require("plate").standing()
model:grow{ break_ratio = 0 } -- wrong
