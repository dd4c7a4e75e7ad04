-- exit code: 2
-- says: on = "w+": no such place
-- says: x-

local model = require("plate").model()
model:fix{ on = "w+" } -- wrong
