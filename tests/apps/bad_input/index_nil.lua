-- exit code: 2
-- says: attempt to index a nil value

local plate = {}
print(plate.shape.size) -- wrong
