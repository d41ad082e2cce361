# A golden test in CI
# The first run writes the expected pictures; after a change of the model the check fails and shows the difference.
mkdir -p pictures/models
cp "$HALFLIT_EXAMPLES/knot.glb" pictures/models
cat >pictures/golden.json <<'JSON'
{"schema": "halflit.golden-list/1", "scenes": [{"name": "knot", "scene": "models/knot.glb", "flags": ["--size", "320x240"]}]}
JSON
halflit golden update pictures
halflit golden check pictures
sed -i 's/"320x240"\]/"320x240", "--azimuth", "38"]/' pictures/golden.json  # somebody turns the camera by 3 degrees
halflit golden check pictures --junit golden.xml || echo "the check fails, as it should"
