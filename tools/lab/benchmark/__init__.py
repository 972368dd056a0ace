"""What tools/lab/bench is made of: measuring, fitting, tables and plots."""
