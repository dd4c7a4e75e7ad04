-- Reference solution of a notched beam in three-point bending: the fictitious crack of Hillerborg, Modeer and
-- Petersson (1976) on the ligament of an elastic half beam, solved as Petersson (1981) and Carpinteri (1985) did, with
-- influence factors. Nothing of it is shared with the solver under test.
--
-- Half beam in plane stress, rectangles of four nodes with Wilson's incompatible modes (Taylor, Beresford and Wilson
-- 1976). The ligament's nodes have closing forces q = traction x area; w = C q + c P is their opening. For a crack tip
-- at node k the traction there is the strength, below it the softening line, above it nothing opens: linear equations
-- for P and the forces, so that a snap-back is no obstacle. Per unit of thickness.
local reference = {}

-- Stiffness of a rectangle a x b in plane stress with the incompatible modes condensed; nodes counter-clockwise.
local function rectangle(a, b, E, nu)
  local f = E / (1 - nu * nu)
  local D = { {f, f * nu, 0}, {f * nu, f, 0}, {0, 0, f * (1 - nu) / 2} }
  local corner = { {-1, -1}, {1, -1}, {1, 1}, {-1, 1} }
  local K = {}
  for i = 1, 12 do K[i] = {} for j = 1, 12 do K[i][j] = 0 end end
  local g = 1 / math.sqrt(3)
  for _, s in ipairs{-g, g} do
    for _, t in ipairs{-g, g} do
      local B = { {}, {}, {} }
      local function column(i, dx, dy)
        B[1][i], B[2][i], B[3][i] = dx, 0, dy
        B[1][i + 1], B[2][i + 1], B[3][i + 1] = 0, dy, dx
      end
      for n, c in ipairs(corner) do
        column(2 * n - 1, c[1] * (1 + c[2] * t) / 4 * 2 / a, c[2] * (1 + c[1] * s) / 4 * 2 / b)
      end
      column(9, -2 * s * 2 / a, 0)
      column(11, 0, -2 * t * 2 / b)
      for i = 1, 12 do
        local d = {}
        for r = 1, 3 do d[r] = D[r][1] * B[1][i] + D[r][2] * B[2][i] + D[r][3] * B[3][i] end
        for j = 1, 12 do
          K[i][j] = K[i][j] + (d[1] * B[1][j] + d[2] * B[2][j] + d[3] * B[3][j]) * a * b / 4
        end
      end
    end
  end
  for m = 12, 9, -1 do -- condense the inner modes
    for i = 1, m - 1 do
      local r = K[i][m] / K[m][m]
      for j = 1, m - 1 do K[i][j] = K[i][j] - r * K[m][j] end
    end
  end
  return K
end

-- The same for constant-strain triangles, as the mean of both cuts of the rectangle: an estimate of the error of linear
-- tetrahedra.
local function triangles(a, b, E, nu)
  local f = E / (1 - nu * nu)
  local D = { {f, f * nu, 0}, {f * nu, f, 0}, {0, 0, f * (1 - nu) / 2} }
  local corner = { {0, 0}, {a, 0}, {a, b}, {0, b} }
  local K = {}
  for i = 1, 8 do K[i] = {} for j = 1, 8 do K[i][j] = 0 end end
  for _, nodes in ipairs{ {1, 2, 3}, {1, 3, 4}, {1, 2, 4}, {2, 3, 4} } do
    local B, at = { {}, {}, {} }, {}
    for i = 1, 3 do
      local j, k = corner[nodes[i % 3 + 1]], corner[nodes[(i + 1) % 3 + 1]]
      local dx, dy = (j[2] - k[2]) / (a * b), (k[1] - j[1]) / (a * b)
      B[1][2 * i - 1], B[2][2 * i - 1], B[3][2 * i - 1] = dx, 0, dy
      B[1][2 * i], B[2][2 * i], B[3][2 * i] = 0, dy, dx
      at[2 * i - 1], at[2 * i] = 2 * nodes[i] - 1, 2 * nodes[i]
    end
    for i = 1, 6 do
      local d = {}
      for r = 1, 3 do d[r] = D[r][1] * B[1][i] + D[r][2] * B[2][i] + D[r][3] * B[3][i] end
      for j = 1, 6 do
        K[at[i]][at[j]] = K[at[i]][at[j]] + (d[1] * B[1][j] + d[2] * B[2][j] + d[3] * B[3][j]) * a * b / 4
      end
    end
  end
  return K
end

-- Places from 0 to `length`, steps growing from `first` to about `last`.
local function graded(first, last, length)
  local x, step = {0}, first
  while x[#x] < length do
    x[#x + 1] = x[#x] + step
    step = math.min(step * 1.15, last)
  end
  local scale = length / x[#x]
  for i = 1, #x do x[i] = x[i] * scale end
  return x
end

-- Banded L D L^T in place; rows[i][j - i] for j >= i.
local function factor(rows, n, band)
  for i = 1, n do
    local row = rows[i]
    local pivot = row[0]
    for j = 1, math.min(band, n - i) do
      local f = row[j] / pivot
      if f ~= 0 then
        local target = rows[i + j]
        for k = j, math.min(band, n - i) do target[k - j] = target[k - j] - f * row[k] end
      end
    end
  end
end

local function solve(rows, n, band, b)
  for i = 1, n do
    local row, v = rows[i], b[i] / rows[i][0]
    if v ~= 0 then
      for j = 1, math.min(band, n - i) do b[i + j] = b[i + j] - row[j] * v end
    end
  end
  for i = n, 1, -1 do
    local row, v = rows[i], b[i]
    for j = 1, math.min(band, n - i) do v = v - row[j] * b[i + j] end
    b[i] = v / row[0]
  end
  return b
end

-- Dense equations by elimination with row exchange.
local function dense(A, b)
  local n = #b
  for i = 1, n do
    local p = i
    for r = i + 1, n do if math.abs(A[r][i]) > math.abs(A[p][i]) then p = r end end
    A[i], A[p], b[i], b[p] = A[p], A[i], b[p], b[i]
    for r = i + 1, n do
      local f = A[r][i] / A[i][i]
      if f ~= 0 then
        for c = i, n do A[r][c] = A[r][c] - f * A[i][c] end
        b[r] = b[r] - f * b[i]
      end
    end
  end
  for i = n, 1, -1 do
    for c = i + 1, n do b[i] = b[i] - A[i][c] * b[c] end
    b[i] = b[i] / A[i][i]
  end
  return b
end

-- given: depth, length, notch, strip (half of the load's width), elements (through the ligament), E, nu, and with
-- constant_strain = true triangles of constant strain, far from the notch as long as `coarse`.
-- Influence factors of the half beam: opening of the ligament's nodes, deflection of the load, mouth.
function reference.influence(given)
  local m = given.elements -- also through the notch
  local ny = math.floor(m * given.depth / (given.depth - given.notch) + 0.5)
  local h = given.depth / ny
  local first = ny - m + 1 -- row of the tip, from 1
  local x = graded(h, given.coarse or given.depth / 10, given.length / 2)
  local nx = #x - 1
  local function number(i, j) return ((i - 1) * (ny + 1) + j - 1) * 2 end -- column i, row j
  local n, band = 2 * (nx + 1) * (ny + 1), 2 * (ny + 2) + 1
  local rows = {}
  for i = 1, n do rows[i] = {} for j = 0, band do rows[i][j] = 0 end end
  for i = 1, nx do
    local K = (given.constant_strain and triangles or rectangle)(x[i + 1] - x[i], h, given.E, given.nu)
    for j = 1, ny do
      local at = { number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1) }
      local dof = {}
      for c = 1, 4 do dof[2 * c - 1], dof[2 * c] = at[c] + 1, at[c] + 2 end
      for r = 1, 8 do
        for c = 1, 8 do
          if dof[c] >= dof[r] then
            local row = rows[dof[r]]
            row[dof[c] - dof[r]] = row[dof[c] - dof[r]] + K[r][c]
          end
        end
      end
    end
  end
  -- A stiff spring holds the support. Springs of the stiffness E on the ligament keep the half beam from turning;
  -- the equations below give their force back, but for the top node, which stays closed.
  local stiff = given.E * 1e6
  rows[number(nx + 1, 1) + 2][0] = rows[number(nx + 1, 1) + 2][0] + stiff
  for j = first, ny do rows[number(1, j) + 1][0] = rows[number(1, j) + 1][0] + given.E end
  local top = number(1, ny + 1) + 1
  rows[top][0] = rows[top][0] + stiff
  factor(rows, n, band)

  -- Load of 1/2 (half of a unit) spread evenly over the strip.
  local weight, sum = {}, 0
  for i = 1, nx + 1 do
    if x[i] <= given.strip + 1e-9 then
      local w = (i == 1 and x[2] / 2) or (x[i + 1] - x[i - 1]) / 2
      weight[i], sum = w, sum + w
    end
  end
  local function unit(set)
    local b = {}
    for i = 1, n do b[i] = 0 end
    set(b)
    return solve(rows, n, band, b)
  end
  local function deflection(u)
    local d = 0
    for i, w in pairs(weight) do d = d - u[number(i, ny + 1) + 2] * w / sum end
    return d
  end
  local load = unit(function(b) for i, w in pairs(weight) do b[number(i, ny + 1) + 2] = -w / sum / 2 end end)
  local result = { spring = given.E / 2, area = {}, C = {}, c = {}, cd = {}, cm = {}, nodes = m, y = {},
                   dP = deflection(load), mP = 2 * load[number(1, 1) + 1] }
  for k = 1, m do
    result.y[k] = (first + k - 2) * h
    result.area[k] = (k == 1 and 0.5 or 1) * h
    result.c[k] = 2 * load[number(1, first + k - 1) + 1]
  end
  for k = 1, m do
    local u = unit(function(b) b[number(1, first + k - 1) + 1] = -1 end) -- a closing force on the half
    result.C[k] = {}
    for i = 1, m do result.C[k][i] = 2 * u[number(1, first + i - 1) + 1] end -- opening is twice the half's
    result.cd[k], result.cm[k] = deflection(u), 2 * u[number(1, 1) + 1]
  end
  return result
end

-- Those of a beam of the same shape, `scale` times as large: in a plane a force moves it as far.
function reference.scaled(factors, scale)
  local result = {}
  for name, value in pairs(factors) do result[name] = value end
  for _, name in ipairs{"area", "y"} do
    result[name] = {}
    for k, value in ipairs(factors[name]) do result[name][k] = scale * value end
  end
  return result
end

-- Curve for a linear softening law: lists deflection, load (per thickness), mouth, tip (height), from the elastic
-- state in which the tip's node reaches the strength on. Its work is the area under it.
function reference.curve(given, factors)
  local f, m = factors or reference.influence(given), given.elements
  local ft, wc = given.strength, 2 * given.energy / given.strength
  local curve = { deflection = {0}, load = {0}, mouth = {0}, tip = {f.y[1]} }
  for k = 1, m do
    -- Unknowns: q_1 .. q_m, less what the springs carry, and P. Nodes 1 .. k-1 soften or are free; at node k, which
    -- just begins, the force is ft area; it and those above are closed.
    local free = {}
    local q
    for _ = 1, 50 do
      local A, b = {}, {}
      for i = 1, m do
        local row = {}
        for j = 1, m + 1 do row[j] = 0 end
        local right = 0
        if i < k then -- q / area = ft (1 - w / wc), w = C q + c P
          local r = f.spring + (free[i] and 0 or ft * f.area[i] / wc)
          for j = 1, m do row[j] = r * f.C[j][i] end
          row[i] = row[i] + 1
          row[m + 1] = r * f.c[i]
          right = free[i] and 0 or ft * f.area[i]
        else
          for j = 1, m do row[j] = f.C[j][i] end
          row[m + 1] = f.c[i]
        end
        A[i], b[i] = row, right
      end
      local last = {}
      for j = 1, m + 1 do last[j] = j == k and 1 or 0 end
      A[m + 1], b[m + 1] = last, ft * f.area[k]
      q = dense(A, b)
      local changed = false
      for i = 1, k - 1 do
        local w = f.c[i] * q[m + 1]
        for j = 1, m do w = w + f.C[j][i] * q[j] end
        local opened = w > wc
        if opened ~= (free[i] or false) then free[i], changed = opened, true end
      end
      if not changed then break end
    end
    local P = q[m + 1]
    local d, mouth = f.dP * P, f.mP * P
    for j = 1, m do d, mouth = d + f.cd[j] * q[j], mouth + f.cm[j] * q[j] end
    local n = #curve.load + 1
    curve.deflection[n], curve.load[n], curve.mouth[n], curve.tip[n] = d, P, mouth, f.y[k]
  end
  return curve
end

-- Largest load and its deflection.
function reference.peak(curve)
  local best = 1
  for i = 1, #curve.load do if curve.load[i] > curve.load[best] then best = i end end
  return curve.load[best], curve.deflection[best]
end

return reference
