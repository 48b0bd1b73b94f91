"""Which convention is this matrix in?"""
