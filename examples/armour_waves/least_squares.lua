-- Least squares: coefficients of y = sum_j c_j x_j, and their standard errors; none where the rows do not tell.
local function least_squares(rows, y)
  local n, a = #rows[1], {}
  for i = 1, n do
    a[i] = {}
    for j = 1, 2 * n + 1 do a[i][j] = j == n + 1 + i and 1 or 0 end
    for r, x in ipairs(rows) do
      for j = 1, n do a[i][j] = a[i][j] + x[i] * x[j] end
      a[i][n + 1] = a[i][n + 1] + x[i] * y[r]
    end
  end
  for i = 1, n do -- Gauss-Jordan: column n + 1 becomes the solution, those after it the inverse
    local pivot = i
    for k = i + 1, n do
      if math.abs(a[k][i]) > math.abs(a[pivot][i]) then pivot = k end
    end
    a[i], a[pivot] = a[pivot], a[i]
    if math.abs(a[i][i]) < 1e-9 then return nil end
    for j = 2 * n + 1, i, -1 do a[i][j] = a[i][j] / a[i][i] end
    for k = 1, n do
      if k ~= i then
        for j = 2 * n + 1, i, -1 do a[k][j] = a[k][j] - a[k][i] * a[i][j] end
      end
    end
  end
  local c, errors, residual = {}, {}, 0
  for i = 1, n do c[i] = a[i][n + 1] end
  for r, x in ipairs(rows) do
    local model = 0
    for j = 1, n do model = model + c[j] * x[j] end
    residual = residual + (y[r] - model) ^ 2
  end
  for i = 1, n do errors[i] = #rows > n and math.sqrt(residual / (#rows - n) * a[i][n + 1 + i]) or nil end
  return c, errors
end

return least_squares
