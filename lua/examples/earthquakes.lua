local cdem = require "cdem"
local soil = cdem.elastic{ youngs_modulus = 200e6, poissons_ratio = 0.3, density = 1900,
                         damping = { fraction = 0.05, frequency = 2 } }
local mesh = cdem.box_mesh{ size = {2, 1, 4}, divisions = {2, 1, 4} }
local model = cdem.model{ bodies = { { name = "soil", shape = mesh, material = soil } } }
model:fix{ on = {"y-", "y+"}, axes = "y" }

-- example: cdem.record
local time = cdem.linspace(0, 0.2, 41)
local acceleration = {}
for i, t in ipairs(time) do acceleration[i] = 0.1 * math.sin(10 * math.pi * t) end
cdem.write_csv{ file = "record.csv", columns = { { name = "time", values = time }, { name = "a", values = acceleration } } }
local outcrop = cdem.record{ file = "record.csv", value = "a", unit = "g", to = "velocity", baseline = "straight" }

-- example: model:quiet
model:quiet{ on = "z-", velocity = {0.5, 0, 0}, amplitude = outcrop } -- the rising wave: half of the outcrop's motion

-- example: model:free_field
model:free_field{ on = {"x-", "x+"} }
model:run{ duration = 0.02 }
