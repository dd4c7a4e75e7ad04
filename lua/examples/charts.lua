local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local joint = cdem.mohr_coulomb{ cohesion = 2e6, friction_angle = 35, tensile_strength = 1e6 }
local shape = cdem.grid{ size = {1, 1, 0.25}, divisions = {4, 4, 1} }
local model = cdem.model{ bodies = { { name = "plate", shape = shape, material = concrete, joint = joint } } }
model:fix{ on = "y-" }
model:probe{ name = "top", field = "displacement.y", at = {0.5, 1, 0.1} }
model:traction{ on = "y+", stress = {0, 3e6, 0} }
model:run{ duration = 5e-4 }

-- example: cdem.chart
local x = cdem.linspace(0, 2 * math.pi, 50)
local sine, cosine = {}, {}
for i, value in ipairs(x) do sine[i], cosine[i] = math.sin(value), math.cos(value) end
cdem.chart{ file = "waves.png", title = "Two waves", x_label = "angle (rad)", y_label = "value (-)",
            series = { { name = "sine", x = x, y = sine }, { name = "cosine", x = x, y = cosine, style = "dashed" } } }

-- example: model:chart
model:chart{ file = "top.png", title = "Top of the plate", x = "time", x_label = "time (s)", y = {"top"},
             y_label = "displacement (m)" }

-- example: model:chart_fragments
model:chart_fragments{ file = "fragments.png", title = "Fragments by size" }
