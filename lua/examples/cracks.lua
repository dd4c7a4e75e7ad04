local cdem = require "cdem"
local glass = cdem.elastic{ youngs_modulus = 65e9, poissons_ratio = 0.2, density = 2450 }
local joint = cdem.mohr_coulomb{ cohesion = 9e6, friction_angle = 30, tensile_strength = 3e6, softening = "linear",
                                 fracture_energy_1 = 50, fracture_energy_2 = 500 }
local solid = cdem.solid.cut{ solid = cdem.solid.box{ size = {0.1, 0.04, 0.01} },
                              tools = { cdem.solid.box{ size = {0.05, 0.002, 0.01}, origin = {0, 0.019, 0} } } }
local model = cdem.model{ bodies = { { name = "plate", shape = solid:mesh{ size = 0.006 }, material = glass, joint = joint } } }
model:fix{ on = "z-", axes = "z" }
model:traction{ on = "y+", stress = {0, 0.04e6, 0} }
model:traction{ on = "y-", stress = {0, -0.04e6, 0} }
model:fix{ on = cdem.select.box{ min = {0.099, 0, 0}, max = {0.1, 0.04, 0.01} }, axes = "xy" }

-- example: model:j_integral
model:relax{ residual = 1e-6 }
local j = model:j_integral{ point = {0.05, 0.02, 0}, front = {0, 0, 1}, growth = {1, 0, 0}, radii = {0.012, 0.016} }
print(j.j) -- J/m2

-- example: model:record_cracks
model:record_cracks{ name = "crack" } -- columns crack_area, crack_energy ... of history.csv

-- example: model:cracks
model:clear_loads() -- otherwise the new tractions add to the old ones
model:traction{ on = "y+", stress = {0, 2.04e6, 0} }
model:traction{ on = "y-", stress = {0, -2.04e6, 0} }
model:run{ duration = 6e-5 }
local cracks = model:cracks()
print(cracks.area, cracks.energy) -- m2, J

-- example: model:crack_tip
local tip = model:crack_tip{ point = {0.05, 0.02, 0.005}, direction = {1, 0, 0}, width = 0.01 }
print(#tip.time)

-- example: cdem.rayleigh_speed
print(cdem.rayleigh_speed(glass)) -- m/s
