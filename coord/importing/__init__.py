"""Other people's floors and benchmarks into problem files that a person can read and edit."""
