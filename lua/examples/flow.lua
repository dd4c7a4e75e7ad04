local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local joint = cdem.mohr_coulomb{ cohesion = 2e6, friction_angle = 35, tensile_strength = 1e6 }
local mesh = cdem.box_mesh{ size = {0.3, 0.3, 1.2}, divisions = {2, 2, 6} }
local model = cdem.model{ bodies = { { name = "column", shape = mesh, material = concrete, joint = joint, bonds = "springs" } } }

-- example: cdem.flow_pressure cdem.flow_velocity
print(cdem.flow_pressure(10))     -- 51250 Pa
print(cdem.flow_velocity(51250))  -- 10 m/s

-- example: model:flow
model:flow{ direction = {1, 0, 0}, velocity = 5 }
model:fix{ on = "z-" }
model:relax{ residual = 1e-4 }
model:clear_loads()
model:flow{ on = "x-", direction = {1, 0, 0}, velocity = function(t) return math.min(5, 100 * t) end,
            relative = false } -- the pressure that stands still surfaces feel, also on ones that move

-- example: model:critical_flow
local other = cdem.model{ bodies = { { shape = mesh, material = concrete, joint = joint, bonds = "springs" } } }
other:fix{ on = "z-" }
local broken = other:critical_flow{ direction = {1, 0, 0}, held = "z-", mode = "ramp", pressure_rate = 1e8 }
print(broken.velocity, broken.fragments[1].volume) -- m/s, m3
