-- exit code: 2
-- says: file = "a.jpg"
-- says: .png

local model = require("plate").standing()
model:picture{ file = "a.jpg" } -- wrong
