-- A cohesive slab that falls on a rigid floor: nodes are freed while contacts act, and several pieces share a key.
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500, stiffness_damping = 1e-6 }
local rough = cdem.coulomb{ friction_angle = 30 }
local joint = cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 35, tensile_strength = 3e5, softening = "exponential",
                                 fracture_energy_1 = 10, fracture_energy_2 = 100 }
local floor = cdem.solid.box{ size = {3, 3, 0.3}, origin = {-1.5, -1.5, -0.3} }:mesh{ size = 1 }
local slab = cdem.solid.box{ size = {0.6, 0.6, 0.12}, origin = {-0.3, -0.3, 0.002} }:mesh{ size = 0.07 }
local model = cdem.model{ bodies = { { shape = floor, material = rock, element = "rigid", name = "floor" },
  { shape = slab, material = rock, joint = joint, bonds = "cohesive", name = "slab" } },
  contacts = { { "floor", "slab", rough }, { "slab", "slab", rough } } }
model:fix{ on = "floor" }
model:gravity{ vector = {0, 0, -9.81} }
model:initial_velocity{ on = "slab", velocity = {0.5, 0, -5}, angular_velocity = {0.5, 0.2, 0} }
model:run{ steps = 120 }
cdem.report{ { name = "breaks", value = #model:breaks() }, { name = "contacts", value = model:contacts().acting },
             { name = "hash", value = model.state_hash } }
