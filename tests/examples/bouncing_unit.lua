-- An armour unit dropped on a floor, on a coarse mesh: two single falls. It touches at sqrt(2 g h), energy is kept and
-- it does not go into the floor; at a sixteenth of the velocity T / rho c at which a bar that hits flat breaks no bond
-- does, and it bounces; at more than three times that velocity no unit comes off whole. The law between, which piece
-- comes off when, depends on the mesh (see the example's page) and is not tested. A unit with a fracture energy breaks when
-- it falls from higher up, and its pieces fly on with the ledger closed.
local cdem = require "cdem"
local expect = require "expect"

local results = cdem.sweep{ script = "../../examples/bouncing_unit/case.lua",
                            set = { { fineness = 3.0, falls = 1, height = 0.0024, tensile_strength = 30e6 },
                                    { fineness = 3.0, falls = 1, height = 0.08 },
                                    { fineness = 3.0, falls = 1, height = 6, fracture_energy = 100, after = 0.02 } } }
for _, result in ipairs(results) do
  if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
  -- Half of the velocity of the low fall comes from gravity on the way left to fall; a step of 1 us counts nothing.
  expect.between(result.figures, "touch_velocity_error", 0, 1e-3)
  expect.between(result.figures, "max_penetration_over_height", 0, 0.01)
end
local low, high = results[1].figures, results[2].figures
expect.equal(low, "first_fall_bonds_broken", 0)
expect.near(low, "first_fall_largest_piece", 1, 1e-9)
-- Up again, by no more than it came down with: what is missing turns it, rings in it or is taken by friction.
expect.between(low, "first_fall_rebound", 0.1, 1)
expect.between(low, "energy_balance_error", 0, 1e-4)
expect.between(high, "first_fall_bonds_broken", 10, 1e4)
expect.between(high, "first_fall_largest_piece", 0, 0.99)
expect.between(high, "energy_balance_error", 0, 0.01)
local tough = results[3].figures
expect.between(tough, "first_fall_largest_piece", 0, 0.9)
expect.between(tough, "pieces_above_a_hundredth", 2, 100)
expect.between(tough, "energy_balance_error", 0, 0.01)
expect.done()
