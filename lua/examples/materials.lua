local cdem = require "cdem"

-- example: cdem.elastic
local granite = cdem.elastic{ youngs_modulus = 50e9, poissons_ratio = 0.25, density = 2650 }
local soil = cdem.elastic{ youngs_modulus = 200e6, poissons_ratio = 0.3, density = 1900,
                           damping = { fraction = 0.05, frequency = 2 } } -- 5 % of critical damping at 2 Hz
print(granite.density, soil.density)

-- example: cdem.plastic
local clay = cdem.plastic{ cohesion = 20e3, friction_angle = 20, tensile_strength = 0, dilation_angle = 0 }
-- in a body: { shape = ..., material = soil, plasticity = clay, zone_size = 1 }
print(clay)

-- example: cdem.hoek_brown
local rock_mass = cdem.hoek_brown{ sigma_ci = 50e6, gsi = 60, m_i = 12, residual = { gsi = 30 }, softening_strain = 0.01 }
-- in a body: { shape = ..., material = granite, plasticity = rock_mass, zone_size = 1 }
print(rock_mass)

-- example: cdem.hoek_brown_bond
local jointed = cdem.hoek_brown_bond{ sigma_ci = 50e6, gsi = 60, m_i = 12, disturbance = 0.5, friction_angle = 35 }
-- in a body: { shape = mesh, material = granite, joint = jointed } cracks where the stress meets the curve
print(jointed)

-- example: cdem.mohr_coulomb
local brittle = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local softening = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 35, tensile_strength = 3e6, softening = "linear",
                                     fracture_energy_1 = 100, fracture_energy_2 = 1000 } -- J/m2
print(brittle, softening)

-- example: cdem.coulomb
local friction = cdem.coulomb{ friction_angle = 35 } -- no cohesion, no tensile strength
print(friction)

-- example: cdem.glued
local construction = cdem.glued{} -- faces that were cut for the excavation only and never break
print(construction)

-- example: cdem.barton_bandis
local rough = cdem.barton_bandis{ jrc = 10, jcs = 60e6, residual_friction_angle = 28, initial_stiffness = 20e9,
                                  maximum_closure = 0.3e-3, length = 2 }
print(rough)

-- example: cdem.joint_table
local measured = cdem.joint_table{ normal = { {0, 0}, {1e-4, 1e6}, {2e-4, 5e6} }, -- {closure, pressure}, m and Pa
                                   shear = { {0, 0}, {1e6, 0.8e6}, {5e6, 3e6} } } -- {pressure, strength}, Pa
print(measured)
