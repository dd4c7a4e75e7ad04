local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local model = cdem.model{ bodies = { { name = "plate", shape = cdem.grid{ size = {1, 1, 0.1}, divisions = {4, 4, 1} },
                                       material = rock, joint = joint } } }

-- example: model:fix
model:fix{ on = "y-" }                                           -- held in x, y and z
model:fix{ on = {"z-", "z+"}, axes = "z" }                       -- rollers
model:fix{ on = "y+", axes = "y", velocity = {0, -0.01, 0} }     -- moved by model:run, m/s
model:fix{ on = "x+", axes = "x", displacement = {1e-4, 0, 0} }  -- where it is at the end of the next run or relaxation

-- example: model:release
model:release{ on = "y+", axes = "y" }

-- example: model:traction
model:traction{ on = "y+", stress = {0, -1e6, 0} }               -- 1 MPa downwards
model:traction{ on = "x+", stress = {-1e5, 0, 0}, amplitude = { {0, 0}, {0.1, 1} } } -- grows from 0 over 0.1 s
model:traction{ on = "x-", stress = {1e5, 0, 0}, since = model.time, amplitude = { {0, 0}, {0.1, 1} } } -- from now on

-- example: model:force
model:force{ on = cdem.select.box{ min = {0.4, 1, 0}, max = {0.6, 1, 0.1} }, force = {0, -5e3, 0} } -- N in all

-- example: model:gravity
model:gravity{ vector = {0, -9.81, 0} }
model:gravity{ vector = {0, -9.81, 0}, water_density = 1025 }    -- under water

-- example: model:break_bonds
local points = model:break_bonds{ on = cdem.select.box{ min = {0.5, 0.8, 0}, max = {0.5, 1, 0.1} } } -- a notch
print(points)

-- example: model:unbond
model:break_bonds{ on = cdem.select.box{ min = {0.5, 0.6, 0}, max = {0.5, 0.8, 0.1} } } -- model:unbond was its name

-- example: model:remove
local blocks = model:remove{ on = cdem.select.box{ min = {0, 0.75, 0}, max = {0.25, 1, 0.1} } }
print(blocks) -- 1

-- example: model:relax_excavation
local ground = cdem.model{ bodies = { { shape = cdem.grid{ size = {3, 1, 3}, divisions = {3, 1, 3} }, material = rock,
                                        joint = joint } } }
ground:initial_stress{ stress = {-1e6, -1e6, -1e6, 0, 0, 0} }
ground:remove{ on = cdem.select.box{ min = {1, 0, 1}, max = {2, 1, 2} }, relaxed = 0.4 } -- 60 % of its forces stay
ground:relax_excavation{ relaxed = 0.7, over = 0.01 } -- from 40 to 70 % in the next 0.01 s of model:run
ground:relax_excavation{}                             -- all of it, at once

-- example: model:crack_pressure
local block = cdem.model{ bodies = { { name = "rock", shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {4, 4, 4} },
                                       material = rock, joint = joint } } } -- a cohesive body
block:crack_pressure{ on = "rock", pressure = 2e6, amplitude = { {0, 0}, {0.01, 1} } } -- gas, Pa
block:clear_loads()
block:crack_pressure{ on = "rock", volume = 1e-5, bulk_modulus = 2.2e9, reservoir = 1e-3,
                      amplitude = { {0, 0}, {1, 1} } } -- water, 1e-5 m3 a second

-- example: model:clear_loads
model:clear_loads()

-- example: model:initial_velocity
local flying = cdem.model{ bodies = { { name = "unit", shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} },
                                        material = rock } } }
flying:initial_velocity{ on = "unit", velocity = {2, 0, 0}, angular_velocity = {0, 0, 2 * math.pi} } -- a turn a second

-- example: model:make_rigid model:make_deformable
flying:make_rigid{ on = "unit" } -- keeps its shape and its stress
flying:run{ duration = 1e-3, time_step = 1e-4 }
flying:make_deformable{ on = "unit" }
