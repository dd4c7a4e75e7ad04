local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local joint = cdem.mohr_coulomb{ cohesion = 2e6, friction_angle = 35, tensile_strength = 1e6 }
local mesh = cdem.box_mesh{ size = {0.3, 0.3, 1.2}, divisions = {2, 2, 6} }
local model = cdem.model{ bodies = { { name = "column", shape = mesh, material = concrete, joint = joint, bonds = "cohesive" } } }

-- example: cdem.flow_pressure cdem.flow_velocity
print(cdem.flow_pressure(10))     -- 51250 Pa
print(cdem.flow_velocity(51250))  -- 10 m/s

-- example: cdem.water.uniform
local current = cdem.water.uniform{ velocity = {2, 0, 0}, level = 1 }
print(current:at({0, 0, 0}).pressure) -- 10055 Pa

-- example: cdem.water.field
local eddy = cdem.water.field{ velocity = function(x, y) return {-y, x, 0} end,
                               surface = function() return 2 end }
print(eddy:at({1, 0, 0}).acceleration[1]) -- -1 m/s2, towards the middle

-- example: cdem.water.wave water:at
local wave = cdem.water.wave{ height = 2, period = 8, depth = 10 }
local crest = wave:at({0, 0, -1}, 0)
print(crest.surface, crest.velocity[1])

-- example: cdem.water.sea
local sea = cdem.water.sea{ significant_height = 2, peak_period = 8, depth = 10, seed = 3 }
print(sea:at({0, 0, 0}, 100).surface)

-- example: cdem.water.slope
local surf = cdem.water.slope{ bed = { {0, -10}, {20, -10}, {50, 10} }, waves = wave, ramp = 8, duration = 20 }
print(surf.run_up, surf.run_down)

-- example: cdem.water.file
model:initial_velocity{ on = "all", velocity = {2, 0, 0} }
model:save{ file = "flume.vtu" } -- stands for a file of OpenFOAM; that has arrays U, p and alpha.water
local computed = cdem.water.file{ files = {"flume.vtu"}, velocity = "velocity", level = 1 }
print(computed:at({0.1, 0.1, 0.5}).velocity[1]) -- 2 m/s
model:initial_velocity{ on = "all", velocity = {0, 0, 0} }

-- example: model:flow
model:flow{ direction = {1, 0, 0}, velocity = 5 }
model:fix{ on = "z-" }
model:relax{ residual = 1e-4 }
model:clear_loads()
model:flow{ on = "x-", direction = {1, 0, 0}, velocity = function(t) return math.min(5, 100 * t) end,
            relative = false } -- the pressure that stands still surfaces feel, also on ones that move
model:clear_loads()
model:flow{ water = cdem.water.wave{ height = 0.3, period = 3, depth = 1, level = 1 }, drag = 1, added_mass = 0.67 }

-- example: model:critical_flow
local other = cdem.model{ bodies = { { shape = mesh, material = concrete, joint = joint, bonds = "cohesive" } } }
other:fix{ on = "z-" }
local broken = other:critical_flow{ direction = {1, 0, 0}, held = "z-", mode = "ramp", pressure_rate = 1e8 }
print(broken.velocity, broken.fragments[1].volume) -- m/s, m3
