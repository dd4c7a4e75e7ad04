-- exit code: 2
-- says: axes = "xq"
-- says: xyz

local model = require("plate").model()
model:fix{ on = "y-", axes = "xq" } -- wrong
