-- The scripts beside the notched beam's case, shortened. The load that starts the crack does not depend on whether the
-- load or the displacement is led; the path, not on the joints' thickness by more than a tenth of a block.
local cdem = require "cdem"
local expect = require "expect"

local folder = "../../examples/notched_beam/"
local function figures(script, set)
  local result = cdem.sweep{ script = folder .. script, set = { set } }[1]
  if result.exit_code ~= 0 then error(script .. " ended with exit code " .. result.exit_code) end
  return result.figures
end

-- Two increments that do not quite start the crack: the softening way then runs straight up from the notch.
local led = figures("displacement_control.lua", { displacement = 7e-5, increments = 2 })
local forced = figures("case.lua", { support = "roller", load = 1000, passes = 1 })
expect.near(led, "load_that_starts_the_crack_N", forced.load_that_starts_the_crack_N, 0.01)
expect.between(led, "crack_tip_y_m", 0.03 - 1e-9, 0.03 + 1e-9)
expect.between(led, "softening_peak_load_N", 1, led.brittle_peak_load_N) -- damage has begun, and softens the beam
expect.between(led, "energy_balance_error", 0, 0.01)

local study = figures("study.lua", { group = "quick" })
expect.between(study, "largest_distance_between_paths_m", 0, 0.006)
expect.done()
