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

-- example: cdem.stereonet
local cut = cdem.cut_by_joints{ shape = cdem.box{ size = {10, 10, 10} }, sets = {
  { name = "bedding", dip = 25, dip_direction = 140, spacing = 1.5, dip_scatter = 4, direction_scatter = 8 },
  { name = "J1", dip = 75, dip_direction = 250, spacing = 2, dip_scatter = 5, direction_scatter = 5 } } }
cdem.stereonet{ file = "net.png", title = "Joints and the face", shape = cut,
                poles = { { name = "survey", planes = { {30, 90}, {35, 95}, {28, 80} } } },
                planes = { { name = "slope face", dip = 65, dip_direction = 130, dashed = true } } }
