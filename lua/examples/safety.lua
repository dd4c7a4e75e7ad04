local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
-- A block on a plane of 30 degrees.
local wedge = cdem.convex_hull{ points = { {0, 0, 0}, {4, 0, 0}, {0, 0, 4 / math.sqrt(3)},
                                           {0, 1, 0}, {4, 1, 0}, {0, 1, 4 / math.sqrt(3)} } }
local block = cdem.rotate{ shape = cdem.box{ size = {1, 1, 1}, origin = {1, 0, 4 / math.sqrt(3)} }, axis = {0, 1, 0}, angle = 30,
                           centre = {0, 0, 4 / math.sqrt(3)} }
local model = cdem.model{ bodies = { { name = "block", shape = block, material = rock },
                                     { name = "plane", shape = wedge, material = rock } },
                          contacts = { {"block", "plane", cdem.coulomb{ friction_angle = 40 }} } }
model:fix{ on = "plane" }
model:gravity{ vector = {0, 0, -9.81} }
model:relax{ residual = 1e-3 }

-- example: cdem.factor_of_safety
local safety = cdem.factor_of_safety{ model = model, reduce = {"joints"}, lower = 1, upper = 2, tolerance = 0.1,
                                      residual = 1e-3 }
print(safety.factor) -- tan(40) / tan(30) = 1.45, within the tolerance
print(#safety.mechanism.blocks, safety.mechanism.volume) -- what fails: one block of 1 m3

-- example: model:copy
local other = model:copy()
print(other:counts().blocks)

-- example: model:reduce_strength
other:reduce_strength{ factor = 2, reduce = {"joints"} }
print(other:relax{ residual = 1e-3, trial = "half the strength" }.verdict) -- "failing": tan(40) / 2 is below tan(30)
