-- exit code: 2
-- says: call it with a colon
-- says: model:fix

local model = require("plate").model()
model.fix{ on = "y-" } -- wrong
