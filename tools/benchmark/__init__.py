"""What tools/bench is made of: measuring, fitting, tables and plots."""
