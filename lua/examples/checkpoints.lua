local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local model = cdem.model{ bodies = { { name = "plate", shape = cdem.grid{ size = {1, 1, 0.1}, divisions = {4, 4, 1} },
                                       material = rock, joint = joint } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {0, -1e6, 0} }
model:relax{ residual = 1e-4 }

-- example: model:checkpoint
model:checkpoint() -- `cdem resume` can go on from here

-- example: model:save_state model:load_state
model:save_state{ file = "balance.cdem" }
model:run{ duration = 1e-4 }
model:load_state{ file = "balance.cdem" } -- back in balance
