# Draws radius.png: gnuplot radius.gp
if (!exists('ending')) ending = ''
if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {
    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'
} else {
    set terminal png size 1100,700
}
set encoding utf8
set datafile missing 'nan'
set grid linetype 1 linecolor '#c8c8c8' linewidth 1
set border linecolor '#404040'
set key outside right top Left reverse noenhanced
set tics nomirror
set format y '%g'
set style line 1 linecolor '#0072B2' linewidth 2 pointtype 7 pointsize 2.2
set output 'radius.png'.ending
set title 'What spheres cost'
set key outside top center horizontal
set ylabel 'cost of a particle-step over that of points'
set style fill solid 0.85 noborder
set grid noxtics
set boxwidth 0.5
set yrange [0:*]
set offsets 0,0,graph 0.05,0
set xtics ('gas-points' 0, 'gas-spheres' 1, 'gas-decades' 2, 'pinball-points' 3, 'pinball-spheres' 4, 'pinball-decades' 5) rotate by -30 noenhanced
set xrange [-0.6:5.6]
$numbers << EOD
"gas-points" 1
"gas-spheres" 1.89984
"gas-decades" 2.31698
"pinball-points" 1
"pinball-spheres" 2.36711
"pinball-decades" 2.7755
EOD
plot $numbers using ($0+(0)):2 with boxes linestyle 1 title 'cost over points', \
     $numbers using ($0+(0)):2:(sprintf('%.2g',column(2))) with labels offset 0,0.6 font ',10' notitle, \
     1 with lines linecolor '#404040' dashtype 2 notitle
set output
